#pragma once
// Whether what a program printed has arrived.

namespace talus {

/// To be called once, when all is printed. Where standard output could not be written (a full disk, a closed
/// descriptor), says so on standard error.
/// @param code  the exit code of the program so far
/// @return `code`; Exit::io where it was Exit::ok and output is lost
int checked_output(int code, const char* program);

}  // namespace talus

#pragma once

namespace talus::cli {

/// Starts the program over, once, with the settings that its libraries read before main() and that nobody has chosen
/// yet:
/// - GOMP_SPINCOUNT: GNU OpenMP's threads wait for each other actively for milliseconds by default. That is right on an
/// idle machine;
///   beside other programs a run on all cores became thirty times slower.
/// - GLIBC_TUNABLES: large pages for large arrays.
/// Returns if there is nothing to set, or if the system does not let it.
void settle_runtime(char** argv);

}  // namespace talus::cli

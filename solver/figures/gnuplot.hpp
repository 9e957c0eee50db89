#pragma once
// Runs gnuplot: script on its stdin, picture on its stdout, no shell, no start-up file.

#include <filesystem>
#include <string>

namespace talus::figures {

/// Runs `gnuplot --default-settings` on `script` and puts what it writes to its stdout at `output`, which appears by
/// rename.
/// @return what gnuplot said on stderr (warnings)
/// @throws IoError when gnuplot is missing ("install gnuplot-nox"), when it fails (with its message), or when `output`
/// cannot be written
std::string run_gnuplot(const std::string& script, const std::filesystem::path& output);

}  // namespace talus::figures

#pragma once
// Runs gnuplot: script on its stdin, picture on its stdout, no shell, no start-up file.

#include <string>

namespace talus::figures {

/// What gnuplot made of a script.
struct GnuplotOutput {
  std::string picture;   ///< all it wrote to stdout
  std::string warnings;  ///< all it wrote to stderr
};

/// Runs `gnuplot --default-settings` with `script` as its stdin.
/// @throws IoError when gnuplot is missing ("install gnuplot-nox") or fails (with its message)
GnuplotOutput run_gnuplot(const std::string& script);

}  // namespace talus::figures

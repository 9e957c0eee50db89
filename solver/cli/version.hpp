#pragma once

#include <string>

namespace talus::cli {

/// "0.1.0"
std::string version();
/// Version, compiler and the instruction set in use, for `talus --version`.
std::string version_text();

}  // namespace talus::cli

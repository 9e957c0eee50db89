#pragma once
// Files of a test, read and written in one go.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "temporary_directory.hpp"

namespace talus::test {

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace talus::test

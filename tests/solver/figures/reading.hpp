#pragma once
// What the tests read back: datablocks of a script, the size of a .png.

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/files.hpp"

namespace talus::test {

/// Rows of the datablock $name of a gnuplot script.
inline std::vector<std::vector<double>> block(const std::string& script, const std::string& name) {
  const std::size_t start = script.find("$" + name + " << END_OF_DATA\n");
  if (start == std::string::npos) throw std::runtime_error("no datablock " + name);
  const std::size_t first = script.find('\n', start) + 1;
  std::istringstream lines(script.substr(first, script.find("END_OF_DATA", first) - first));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(lines, line);) {
    auto& row = rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;) row.push_back(std::stod(word));
  }
  return rows;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct Size {
  std::uint32_t width, height;
  bool operator==(const Size&) const = default;
};

/// Width and height from the IHDR chunk: after the signature (8 bytes), its length and name (8 bytes), big-endian.
/// PNG, 11.2.2.
inline Size png_size(const std::filesystem::path& path) {
  const std::string bytes = read_file(path, std::size_t{64} << 20);
  if (bytes.size() < 24 || bytes.substr(1, 3) != "PNG" || bytes.substr(12, 4) != "IHDR")
    throw std::runtime_error("not a PNG");
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
  };
  return {number(16), number(20)};
}

}  // namespace talus::test

#pragma once
// Text -> JSON document, for input that nobody has to trust: limits first, then meaning.

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace talus {

using Json = nlohmann::ordered_json;

/// What a document may hold at most.
struct ParseLimits {
  std::size_t bytes = std::size_t{16} << 20;  ///< of text
  std::size_t nesting = 64;                   ///< objects and arrays within one another
  std::size_t values = 2'000'000;             ///< members and elements in all
  std::size_t members = 1000;                 ///< of one object: looking one up is linear
  std::size_t string = 65'536;                ///< bytes of one string or key
};

/// The whole of a regular file, at most `most` bytes.
/// @throws IoError when it cannot be read, ConfigError when it is larger
std::string read_text(const std::filesystem::path& path, std::size_t most = ParseLimits{}.bytes);

/// Parses JSON (RFC 8259: no comments, no NaN). A key that appears twice in one object is a fault.
/// @param source  what to call the text in messages, for example the file's name
/// @throws ConfigError; a syntax error is placed at "source:line:column", the rest at JSON pointers
Json parse_json(std::string_view text, const std::string& source, const ParseLimits& limits = {});

}  // namespace talus

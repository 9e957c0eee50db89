#pragma once
// The one JSON parser, for documents of people, of clients and of our own files: limits first, then meaning.

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "support/error.hpp"

namespace talus {

using Json = nlohmann::ordered_json;

/// What a document may hold at most. The defaults are for documents from outside, whichever way they come in; the large
/// files that Talus itself writes are read with more bytes and values.
struct JsonLimits {
  std::size_t bytes = std::size_t{16} << 20;  ///< of text
  std::size_t nesting = 64;                   ///< objects and arrays within one another
  std::size_t values = 500'000;               ///< members and elements in all: up to 50 bytes of memory each
  std::size_t members = 1000;                 ///< of one object: looking one up is linear
  std::size_t string = 65'536;                ///< bytes of one string or key
};

/// The limits for a file that Talus wrote, of at most `bytes`.
constexpr JsonLimits own_file(std::size_t bytes) { return {.bytes = bytes, .values = bytes, .string = bytes}; }

/// The whole of a regular file, at most `most` bytes.
/// @throws IoError when it cannot be read, ConfigError when it is larger
std::string read_text(const std::filesystem::path& path, std::size_t most = JsonLimits{}.bytes);

/// Parses JSON (RFC 8259: no comments, no NaN) in a time linear in its length; the limits hold while it is read. A key
/// that appears twice in one object is a fault. Thread-safe.
/// @param source  what to call the text in messages, for example the file's name
/// @throws ConfigError; a syntax error is placed at "source:line:column", the rest at JSON pointers
Json parse_json(std::string_view text, const std::string& source, const JsonLimits& limits = {});

/// The text of a file that Talus writes: the object, indented, with `checksum` as its last member, the FNV-1a hash
/// (64 bits, hexadecimal) of the text before that member. It tells a damaged file from a whole one.
/// @param object  has a member, and none named checksum
std::string with_checksum(const Json& object);

/// Reads and parses a file that Talus wrote; of one with a checksum, the text must agree with it. A file of an earlier
/// version has none.
/// @throws IoError naming the path: it cannot be read, is larger than `max_bytes`, is damaged, or is not JSON
Json read_json(const std::filesystem::path& path, std::size_t max_bytes);

/// The same, and what `read` makes of the document. @param what  that the file should be: "a plan of Talus"
/// @throws IoError also where `read` misses a key or finds another type
template <class Read>
auto read_json(const std::filesystem::path& path, std::size_t max_bytes, const std::string& what, const Read& read) {
  const Json document = read_json(path, max_bytes);
  try {
    return read(document);
  } catch (const Json::exception& e) {
    throw IoError(path.string() + " is not " + what + " (" + e.what() + ")");
  }
}

}  // namespace talus

#pragma once

#include <string>
#include <string_view>

namespace talus::service {

/// SHA-256 as 64 hex digits.
std::string sha256(std::string_view text);

/// Whether two texts are equal, in a time that does not depend on where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// `bytes` random bytes from the system as hex digits.
std::string random_hex(std::size_t bytes);
/// Whether random_hex(bytes) may have made this text.
bool is_random_hex(std::string_view text, std::size_t bytes);

}  // namespace talus::service

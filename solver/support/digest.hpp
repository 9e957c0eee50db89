#pragma once
// FNV-1a, 64 bits: http://www.isthe.com/chongo/tech/comp/fnv/. Finds damage and differences, not malice.

#include <cstdint>
#include <string>
#include <string_view>

namespace talus {

inline constexpr std::uint64_t fnv1a64_start = 0xcbf29ce484222325u;

/// The hash of some bytes; `hash` is that of the bytes before them.
constexpr std::uint64_t fnv1a64(std::string_view bytes, std::uint64_t hash = fnv1a64_start) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

/// 16 hexadecimal digits.
inline std::string hex_digits(std::uint64_t value) {
  std::string text(16, '0');
  for (std::size_t k = 0; k < 16; ++k) text[15 - k] = "0123456789abcdef"[(value >> (4 * k)) & 15u];
  return text;
}

}  // namespace talus

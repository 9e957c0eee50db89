#pragma once
// FNV-1a, 64 bits: http://www.isthe.com/chongo/tech/comp/fnv/. Finds damage, not malice.

#include <cstdint>
#include <string_view>

namespace talus {

constexpr std::uint64_t fnv1a64(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

}  // namespace talus

#pragma once
// Reads the head of a request, strictly: whatever two readers could take differently is refused.

#include <optional>
#include <string_view>

#include "base/refusal.hpp"
#include "http/message.hpp"

namespace talus::service {

struct GuardLimits {
  std::size_t head_bytes = 16384;
  std::size_t headers = 64;
  std::size_t target_bytes = 2048;
  std::size_t body_bytes = std::size_t{4} << 20;
};

/// A valid request, but for its body.
struct Head {
  Incoming request = {};           ///< with the headers that a handler looks at, and no others
  std::string replaced_host = {};  ///< the Host header, where the authority of the target stands for it
  std::size_t body = 0;            ///< Content-Length
  bool keep_alive = true;
  bool expects_continue = false;
  bool chunks = true;  ///< the client understands chunked content (HTTP/1.1)
};

/// End of the header (after the empty line); nothing if it is incomplete.
std::optional<std::size_t> head_end(std::string_view bytes);

/// Reads a complete header. The authority of a target in absolute form takes the place of Host (RFC 9112 3.2.2).
/// @throws Refusal; where the next request begins is then unknown
Head judge(std::string_view head, const GuardLimits& limits);

}  // namespace talus::service

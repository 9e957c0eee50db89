#pragma once
// Checks a request before the HTTP library sees any of it.
//
// Debian 12's cpp-httplib (0.11.4) takes chunked bodies beyond its limit, Content-Length together with chunked,
// thousands of ranges, %0d%0a in header values (which it decodes), and any number of headers. So the bytes of a request
// are read and checked here, and the library receives a rewritten header: one request, a correct length, and only the
// headers that a handler looks at. No Range, no Transfer-Encoding and no Content-Type ever reach it.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace talus::service {

struct GuardLimits {
  std::size_t head_bytes = 16384;
  std::size_t headers = 64;
  std::size_t target_bytes = 2048;
  std::size_t body_bytes = std::size_t{4} << 20;
  bool loopback_names_only = false;  ///< without tokens, a web page must not reach the service by another host name
};

/// A valid request header.
struct Head {
  std::string method = {};
  std::size_t body = 0;  ///< Content-Length
  bool keep_alive = true;
  bool expects_continue = false;
  std::string rewritten = {};  ///< for the library, with the empty line
};

/// An invalid request, and the status to answer it with. Where the next request begins is unknown, so the connection is
/// closed.
struct BadRequest {
  int status;
  std::string why;  ///< one line
};

/// Header that carries the client's Content-Type: the library would act on the real one.
inline constexpr const char* body_type_header = "X-Body-Type";

/// End of the header (after the empty line); nothing if it is incomplete.
std::optional<std::size_t> head_end(std::string_view bytes);

/// Checks a complete header. @throws BadRequest
Head judge(std::string_view head, const GuardLimits& limits);

}  // namespace talus::service

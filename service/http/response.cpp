#include "http/response.hpp"

#include <array>
#include <cstdio>
#include <utility>

#include "base/clock.hpp"

namespace talus::service {
namespace {

/// RFC 9110 15; a phrase says nothing that the status does not.
constexpr std::array<std::pair<int, const char*>, 23> phrases{{{200, "OK"},
                                                               {201, "Created"},
                                                               {204, "No Content"},
                                                               {304, "Not Modified"},
                                                               {400, "Bad Request"},
                                                               {401, "Unauthorized"},
                                                               {403, "Forbidden"},
                                                               {404, "Not Found"},
                                                               {405, "Method Not Allowed"},
                                                               {408, "Request Timeout"},
                                                               {409, "Conflict"},
                                                               {410, "Gone"},
                                                               {411, "Length Required"},
                                                               {413, "Content Too Large"},
                                                               {414, "URI Too Long"},
                                                               {415, "Unsupported Media Type"},
                                                               {417, "Expectation Failed"},
                                                               {422, "Unprocessable Content"},
                                                               {429, "Too Many Requests"},
                                                               {431, "Request Header Fields Too Large"},
                                                               {500, "Internal Server Error"},
                                                               {503, "Service Unavailable"},
                                                               {507, "Insufficient Storage"}}};

std::string phrase(int status) {
  for (const auto& [known, text] : phrases)
    if (known == status) return text;
  return status == 504 ? "Gateway Timeout" : "HTTP Version Not Supported";
}

/// A document of this service loads nothing and runs nothing in a browser. Pictures bring their styles and their
/// raster images along.
constexpr const char* content_policy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; frame-ancestors 'none'; sandbox";

}  // namespace

std::string response_text(const Answer& answer, const Framing& framing) {
  std::string text = "HTTP/1.1 " + std::to_string(answer.status) + " " + phrase(answer.status);
  const auto add = [&text](const std::string& name, const std::string& value) { text += "\r\n" + name + ": " + value; };
  add("Date", http_date(system_now()));
  add("X-Content-Type-Options", "nosniff");
  add("Content-Security-Policy", content_policy);
  add("Accept-Ranges", "none");
  for (const auto& [name, value] : answer.headers) add(name, value);
  // RFC 9110 8.6: no length where there can be no content (204), where it is not that of the content that was not sent
  // again (304), and where a stream has none.
  const bool is_stream = answer.type == event_stream, content = answer.status != 204 && answer.status != 304;
  if (content) add("Content-Type", answer.type);
  if (is_stream) add("Cache-Control", "no-store");
  if (content && !is_stream) add("Content-Length", std::to_string(answer.body.size()));
  if (is_stream && framing.chunks && framing.body) add("Transfer-Encoding", "chunked");
  if (!framing.keep_alive) add("Connection", "close");
  text += "\r\n\r\n";
  if (content && !is_stream && framing.body) text += answer.body;
  return text;
}

std::string stream_piece(const std::string& text, bool chunks) {
  if (!chunks) return text;
  std::array<char, 20> size{};
  std::snprintf(size.data(), size.size(), "%zx\r\n", text.size());
  return size.data() + text + "\r\n";
}

}  // namespace talus::service

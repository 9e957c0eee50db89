#pragma once
// One HTTP request to a talusd, with limits for what the other side may send.

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace talus::cli {

struct HttpRequest {
  std::string method;
  std::string path;  ///< with the query
  std::vector<std::pair<std::string, std::string>> headers = {};
  std::string body = {};
  std::chrono::seconds limit = std::chrono::minutes(2);  ///< from the connection to the end of the reply
};

struct HttpReply {
  int status = 0;
  std::string body = {};
};

/// Of a reply: [bytes].
inline constexpr std::size_t max_reply_head = 64 << 10, max_reply_body = std::size_t{64} << 20;

/// Where a server is.
struct ServerUrl {
  bool tls = false;
  std::string host = {};  ///< without brackets
  std::string port = {};
};

/// "http://host", "https://[::1]:8443/". @throws ConfigError where the text is no such URL
ServerUrl read_server_url(const std::string& url);

/// Sends a request and receives the whole reply; a certificate must be valid for the host. A POST
/// is sent once more where the connection breaks.
/// @throws IoError: nothing answers, the connection breaks, the reply is too large or no HTTP; ConfigError for the URL
HttpReply send_request(const std::string& url, const HttpRequest& request);

}  // namespace talus::cli

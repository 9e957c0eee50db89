#include "http/guard.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "http/text.hpp"

namespace talus::service {
namespace {

/// The headers passed on to handlers.
constexpr std::array<std::string_view, 10> passed_on{
    "host",   "accept",        "authorization",     "prefer",      "idempotency-key", "if-none-match",
    "origin", "last-event-id", "x-forwarded-proto", "x-request-id"};

/// RFC 9110: the characters of methods and header names.
bool is_token(std::string_view text) { return !text.empty() && consists_of_letters_digits(text, "!#$%&'*+-.^_`|~"); }

bool is_value(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c == '\t' || (c >= 32 && c != 127); });
}

/// The library decodes %0d, %0a and %u000a in values, and a handler might send one back.
bool hides_control(std::string_view value) {
  for (std::size_t i = value.find('%'); i != std::string_view::npos && i + 2 < value.size();
       i = value.find('%', i + 1)) {
    const std::string code = lower(value.substr(i + 1, 2));
    if (code[0] == '0' || code[0] == '1' || code[0] == 'u' || code == "7f") return true;
  }
  return false;
}

/// What a request target names.
struct Target {
  std::string_view authority = {};  ///< of the absolute form only
  std::string path = {};            ///< with the query; "*": the server as a whole
};

/// RFC 9112 3.2: the origin form, the absolute form of http URIs, and for OPTIONS the asterisk form.
std::optional<Target> read_target(std::string_view method, std::string_view text) {
  constexpr std::string_view scheme = "http://";
  if (!std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > 32 && c < 127; })) return std::nullopt;
  const std::string_view all = method == "OPTIONS" ? "*" : "/";  // 3.2.4: for OPTIONS no path is the server, too
  if (text.starts_with('/') || (text == "*" && text == all)) return Target{.path = std::string(text)};
  if (lower(text.substr(0, scheme.size())) != scheme) return std::nullopt;
  text.remove_prefix(scheme.size());
  const std::string_view authority = text.substr(0, text.find_first_of("/?#"));
  if (authority.empty() || authority.starts_with(':')) return std::nullopt;  // RFC 9110 4.2.1: no host
  text.remove_prefix(authority.size());
  if (text.empty()) return Target{authority, std::string(all)};
  return Target{authority, (text.starts_with('/') ? "" : "/") + std::string(text)};
}

bool is_loopback_name(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1) == "[::1]";
  host = host.substr(0, host.find(':'));
  return host == "localhost" || host == "127.0.0.1";
}

void check_host(std::string_view host, const GuardLimits& limits) {
  if (!consists_of_letters_digits(host, ".-:[]_")) throw BadRequest{400, "the Host header is not a valid host name"};
  if (limits.loopback_names_only && !host.empty() && !is_loopback_name(host))
    throw BadRequest{403, "without --tokens only requests to localhost, 127.0.0.1 and [::1] are accepted"};
}

struct Line {
  std::string name;
  std::string_view value;
};

std::vector<Line> read_headers(std::string_view text, const GuardLimits& limits) {
  std::vector<Line> lines;
  while (!text.empty()) {
    const std::size_t end = text.find("\r\n");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 2);
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon)))
      throw BadRequest{400, "a header line is not \"name: value\""};
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!is_value(value)) throw BadRequest{400, "a header value contains control characters"};
    lines.push_back({lower(line.substr(0, colon)), value});
    if (lines.size() > limits.headers)
      throw BadRequest{431, "more than " + std::to_string(limits.headers) + " headers"};
  }
  return lines;
}

}  // namespace

std::optional<std::size_t> head_end(std::string_view bytes) {
  const std::size_t at = bytes.find("\r\n\r\n");
  return at == std::string_view::npos ? std::nullopt : std::optional(at + 4);
}

Head judge(std::string_view head, const GuardLimits& limits) {
  if (head.size() > limits.head_bytes)
    throw BadRequest{431, "the request header is longer than " + std::to_string(limits.head_bytes) + " bytes"};
  if (head.find('\0') != std::string_view::npos) throw BadRequest{400, "the request header contains a NUL byte"};
  const std::size_t first = head.find("\r\n");
  const std::string_view request = head.substr(0, first);
  const std::size_t a = request.find(' '), b = request.rfind(' ');
  if (a == std::string_view::npos || a == b)
    throw BadRequest{400, "the request line is not \"METHOD target HTTP/1.1\""};
  const std::string_view method = request.substr(0, a), target = request.substr(a + 1, b - a - 1),
                         protocol = request.substr(b + 1);
  if (!is_token(method)) throw BadRequest{400, "the method is not a valid token"};
  if (protocol != "HTTP/1.1" && protocol != "HTTP/1.0")
    throw BadRequest{505, "only HTTP/1.1 and HTTP/1.0 are supported"};
  if (target.size() > limits.target_bytes)
    throw BadRequest{414, "the URI is longer than " + std::to_string(limits.target_bytes) + " bytes"};
  const std::optional<Target> wanted = read_target(method, target);
  if (!wanted) throw BadRequest{400, "the request target is neither a path nor an http URI"};

  // Without the empty line at the end.
  std::vector<Line> lines = read_headers(head.substr(first + 2, head.size() - first - 4), limits);

  Head good{.method = std::string(method), .keep_alive = protocol == "HTTP/1.1"};
  good.rewritten = good.method + " " + wanted->path + " " + std::string(protocol) + "\r\n";
  const auto count = [&](std::string_view name) {
    return std::count_if(lines.begin(), lines.end(), [&](const Line& line) { return line.name == name; });
  };
  if (count("transfer-encoding") > 0 && count("content-length") > 0)
    throw BadRequest{400, "send either Content-Length or Transfer-Encoding, not both"};
  if (count("transfer-encoding") > 0) throw BadRequest{411, "chunked bodies are not supported; send a Content-Length"};
  if (count("content-length") > 1) throw BadRequest{400, "Content-Length occurs more than once"};
  if (count("host") == 0 && good.keep_alive) throw BadRequest{400, "the Host header is missing"};

  const auto named = std::find_if(lines.begin(), lines.end(), [](const Line& line) { return line.name == "host"; });
  std::string_view host = named == lines.end() ? "" : named->value;
  check_host(host, limits);
  if (!wanted->authority.empty()) {  // RFC 9112 3.2.2: it stands for Host
    host = wanted->authority;
    check_host(host, limits);
    if (named == lines.end())
      lines.push_back({"host", host});
    else
      named->value = host;
  }

  for (const Line& line : lines) {
    if (line.name == "content-length") {
      const char* end = line.value.data() + line.value.size();
      const auto [stop, error] = std::from_chars(line.value.data(), end, good.body);
      if (error == std::errc::result_out_of_range) throw BadRequest{413, "the body is too large"};
      if (error != std::errc() || stop != end) throw BadRequest{400, "Content-Length is not a number"};
      if (good.body > limits.body_bytes)
        throw BadRequest{413, "the body is larger than " + std::to_string(limits.body_bytes) + " bytes"};
    } else if (line.name == "connection") {
      if (lower(line.value).find("close") != std::string::npos) good.keep_alive = false;
    } else if (line.name == "expect") {
      if (lower(line.value) != "100-continue") throw BadRequest{417, "the only supported Expect value is 100-continue"};
      good.expects_continue = true;
    } else if (line.name == "content-type") {
      if (hides_control(line.value)) throw BadRequest{400, "a header value contains encoded control characters"};
      good.rewritten += std::string(body_type_header) + ": " + std::string(line.value) + "\r\n";
    } else if (std::find(passed_on.begin(), passed_on.end(), line.name) != passed_on.end()) {
      if (count(line.name) > 1 && line.name != "accept" && line.name != "prefer" && line.name != "if-none-match")
        throw BadRequest{400, line.name + " occurs more than once"};
      if (hides_control(line.value)) throw BadRequest{400, "a header value contains encoded control characters"};
      good.rewritten += line.name + ": " + std::string(line.value) + "\r\n";
    }
  }
  if (limits.loopback_names_only && count("origin") > 0) {
    const auto origin =
        std::find_if(lines.begin(), lines.end(), [](const Line& line) { return line.name == "origin"; });
    if (origin->value != "http://" + std::string(host))
      throw BadRequest{403, "cross-origin requests are rejected unless talusd runs with --tokens"};
  }
  good.rewritten += "Content-Length: " + std::to_string(good.body) + "\r\n\r\n";
  return good;
}

}  // namespace talus::service

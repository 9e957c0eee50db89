#include "http/guard.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>
#include <vector>

#include "http/text.hpp"

namespace talus::service {
namespace {

/// The headers passed on to handlers.
constexpr std::array<std::string_view, 12> passed_on{
    "host",          "accept", "authorization", "content-type",      "prefer",       "idempotency-key",
    "if-none-match", "origin", "last-event-id", "x-forwarded-proto", "x-request-id", "sec-fetch-site"};
/// Those of them that may occur more than once: they are lists.
constexpr std::array<std::string_view, 3> lists{"accept", "prefer", "if-none-match"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void bad(const std::string& why) { throw Refusal(reason::bad_request, why); }

/// RFC 9110: the characters of methods and header names.
bool is_token(std::string_view text) { return !text.empty() && consists_of_letters_digits(text, "!#$%&'*+-.^_`|~"); }

bool is_value(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c == '\t' || (c >= 32 && c != 127); });
}

/// %0d, %0a, %u000a and the like: a proxy or a client might decode a value that comes back to it.
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

/// The path without its percent codes, and the parameters of the query, "a=b&c=d".
void read_path(const std::string& target, Incoming& request) {
  const std::string uri = target.substr(0, target.find('#'));
  const std::size_t mark = uri.find('?');
  request.path = percent_decoded(uri.substr(0, mark), false);
  if (mark == std::string::npos) return;
  for (const std::string& part : split(uri.substr(mark + 1), '&')) {
    if (part.empty()) continue;
    const std::size_t equals = std::min(part.find('='), part.size());
    request.query.emplace(percent_decoded(part.substr(0, equals), true),
                          percent_decoded(part.substr(std::min(equals + 1, part.size())), true));
  }
}

void check_host(std::string_view host) {
  if (!consists_of_letters_digits(host, ".-:[]_")) bad("the Host header is not a valid host name");
}

std::size_t read_length(std::string_view text, std::size_t most) {
  std::size_t length = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (error == std::errc::result_out_of_range) throw Refusal(reason::too_large, "the body is too large");
  if (error != std::errc() || stop != text.data() + text.size()) bad("Content-Length is not a number");
  if (length > most) throw Refusal(reason::too_large, "the body is larger than " + std::to_string(most) + " bytes");
  return length;
}

struct Line {
  std::string name;  ///< in lower case
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
      bad("a header line is not \"name: value\"");
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!is_value(value)) bad("a header value contains control characters");
    lines.push_back({lower(line.substr(0, colon)), value});
    if (lines.size() > limits.headers)
      throw Refusal(reason::headers_too_large, "more than " + std::to_string(limits.headers) + " headers");
  }
  return lines;
}

void keep_header(const Line& line, Head& head, const GuardLimits& limits) {
  if (line.name == "content-length") {
    head.body = read_length(line.value, limits.body_bytes);
  } else if (line.name == "connection") {
    if (lower(line.value).find("close") != std::string::npos) head.keep_alive = false;
  } else if (line.name == "expect") {
    if (lower(line.value) != "100-continue")
      throw Refusal(reason::expectation_failed, "the only supported Expect value is 100-continue");
    head.expects_continue = true;
  } else if (contains(passed_on, line.name)) {
    if (hides_control(line.value)) bad("a header value contains encoded control characters");
    std::string& slot = head.request.headers[line.name];
    if (!slot.empty() && !contains(lists, line.name)) bad(line.name + " occurs more than once");
    slot += (slot.empty() ? "" : ", ") + std::string(line.value);  // RFC 9110 5.2
  }
}

/// The framing headers, over which two readers could disagree.
void check_framing(const std::vector<Line>& lines, bool host_required) {
  const auto count = [&](std::string_view name) {
    return std::count_if(lines.begin(), lines.end(), [&](const Line& line) { return line.name == name; });
  };
  if (count("transfer-encoding") > 0 && count("content-length") > 0)
    bad("send either Content-Length or Transfer-Encoding, not both");
  if (count("transfer-encoding") > 0)
    throw Refusal(reason::length_required, "chunked bodies are not supported; send a Content-Length");
  if (count("content-length") > 1) bad("Content-Length occurs more than once");
  if (count("host") == 0 && host_required) bad("the Host header is missing");
  if (count("host") > 1) bad("host occurs more than once");
}

}  // namespace

std::optional<std::size_t> head_end(std::string_view bytes) {
  const std::size_t at = bytes.find("\r\n\r\n");
  return at == std::string_view::npos ? std::nullopt : std::optional(at + 4);
}

Head judge(std::string_view head, const GuardLimits& limits) {
  if (head.size() > limits.head_bytes)
    throw Refusal(reason::headers_too_large,
                  "the request header is longer than " + std::to_string(limits.head_bytes) + " bytes");
  if (head.find('\0') != std::string_view::npos) bad("the request header contains a NUL byte");
  const std::size_t first = head.find("\r\n");
  const std::string_view request = head.substr(0, first);
  const std::size_t a = request.find(' '), b = request.rfind(' ');
  if (a == std::string_view::npos || a == b) bad("the request line is not \"METHOD target HTTP/1.1\"");
  const std::string_view method = request.substr(0, a), target = request.substr(a + 1, b - a - 1),
                         protocol = request.substr(b + 1);
  if (!is_token(method)) bad("the method is not a valid token");
  if (protocol != "HTTP/1.1" && protocol != "HTTP/1.0")
    throw Refusal(reason::version_not_supported, "only HTTP/1.1 and HTTP/1.0 are supported");
  if (target.size() > limits.target_bytes)
    throw Refusal(reason::uri_too_long, "the URI is longer than " + std::to_string(limits.target_bytes) + " bytes");
  const std::optional<Target> wanted = read_target(method, target);
  if (!wanted) bad("the request target is neither a path nor an http URI");

  const bool newest = protocol == "HTTP/1.1";
  // Without the empty line at the end.
  const std::vector<Line> lines = read_headers(head.substr(first + 2, head.size() - first - 4), limits);
  check_framing(lines, newest);
  Head good{.keep_alive = newest, .chunks = newest};
  good.request.method = method;
  read_path(wanted->path, good.request);
  for (const Line& line : lines) keep_header(line, good, limits);
  check_host(good.request.header("host"));
  check_host(wanted->authority);
  if (!wanted->authority.empty())
    good.replaced_host = std::exchange(good.request.headers["host"], std::string(wanted->authority));
  return good;
}

}  // namespace talus::service

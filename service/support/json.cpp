#include "support/json.hpp"

#include <set>

namespace talus::service {
namespace {

[[noreturn]] void refuse(const std::string& why) { throw Refusal(Reason::bad_request, why, {{"", why}}); }

/// Counts nesting and string lengths without understanding anything else.
void look_over(std::string_view text, const JsonLimits& limits) {
  std::size_t depth = 0, length = 0;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inside) {
      if (c == '"') {
        inside = false;
        continue;
      }
      if (++length > limits.string_bytes)
        refuse("a string is longer than " + std::to_string(limits.string_bytes) + " bytes");
      if (c == '\\') ++i;
    } else if (c == '"') {
      inside = true;
      length = 0;
    } else if (c == '{' || c == '[') {
      if (++depth > limits.nesting) refuse("values are nested deeper than " + std::to_string(limits.nesting));
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
}

}  // namespace

Json parse_json(std::string_view text, const JsonLimits& limits) {
  look_over(text, limits);
  std::vector<std::set<std::string>> keys;
  const auto watch = [&keys](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      refuse("the key \"" + parsed.get<std::string>().substr(0, 80) + "\" stands twice in one object");
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const nlohmann::json::exception&) {
    const bool empty = text.find_first_not_of(" \t\r\n") == std::string_view::npos;
    refuse(empty ? "the body is empty; a JSON value is needed" : "the body is not JSON");
  }
}

std::string dump(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string pointer_token(const std::string& key) {
  std::string out = "/";
  for (const char c : key) c == '~' ? out += "~0" : c == '/' ? out += "~1" : out += c;
  return out;
}

}  // namespace talus::service

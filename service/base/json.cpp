#include "base/json.hpp"

namespace talus::service {

Json parse_body(std::string_view text) try { return parse_json(text, "body"); } catch (const ConfigError& e) {
  Fault first = e.faults.front();
  if (!first.pointer.starts_with("body")) throw Refusal(Reason::bad_request, "the body is refused", e.faults);
  first.message = first.pointer + ": " + first.message;  // a syntax error, at "body:line:column"
  first.pointer.clear();
  throw Refusal(Reason::bad_request, "the body is not JSON", {std::move(first)});
}

std::string dump(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace talus::service

#include "base/json.hpp"

#include <unistd.h>

#include "base/clock.hpp"

namespace talus::service {
namespace {

void log_line(const char* level, const std::string& event, const Json& fields) {
  Json line = {{"time", utc_text(system_now())}, {"level", level}, {"event", event}};
  line.update(fields);
  const std::string text = dump(line) + "\n";
  // One write, so that lines of several threads do not mix; the service goes on if the log cannot be written.
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

Json parse_body(std::string_view text) try { return parse_json(text, "body"); } catch (const ConfigError& e) {
  Fault first = e.faults.front();
  if (!first.pointer.starts_with("body")) throw Refusal(reason::bad_request, "the body is refused", e.faults);
  first.message = first.pointer + ": " + first.message;  // a syntax error, at "body:line:column"
  first.pointer.clear();
  throw Refusal(reason::bad_request, "the body is not JSON", {std::move(first)});
}

std::string dump(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

void log_info(const std::string& event, const Json& fields) { log_line("info", event, fields); }
void log_error(const std::string& event, const Json& fields) { log_line("error", event, fields); }

}  // namespace talus::service

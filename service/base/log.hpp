#pragma once
// Structured log lines: one JSON object a line on stderr.

#include <string>

#include "base/json.hpp"

namespace talus::service {

/// {"time": ..., "level": ..., "event": ..., then `fields`}. Never give it a token or a body.
void log_line(const char* level, const std::string& event, const Json& fields = Json::object());

inline void log_info(const std::string& event, const Json& fields = Json::object()) { log_line("info", event, fields); }
inline void log_error(const std::string& event, const Json& fields = Json::object()) {
  log_line("error", event, fields);
}

}  // namespace talus::service

#pragma once
// JSON of requests and of the log.

#include <string>
#include <string_view>

#include "base/refusal.hpp"
#include "support/json.hpp"

namespace talus::service {

/// Parses a request body, within the limits of every document.
/// @throws Refusal bad_request: not UTF-8 JSON, a key twice in an object, or beyond JsonLimits
Json parse_body(std::string_view text);

/// One line; bytes that are not UTF-8 are replaced.
std::string dump(const Json& value);

/// Writes a line to stderr: {"time", "level", "event"}, then `fields`. Must not be given a token or a body.
/// Thread-safe.
void log_info(const std::string& event, const Json& fields = Json::object());
void log_error(const std::string& event, const Json& fields = Json::object());

}  // namespace talus::service

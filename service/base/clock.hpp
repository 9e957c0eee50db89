#pragma once
// Time in records, requests and headers.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace talus::service {

/// Milliseconds since 1970, UTC.
using Milliseconds = std::int64_t;
/// The source of the time; tests have their own.
using Clock = std::function<Milliseconds()>;

Milliseconds system_now();

/// "2026-01-31T12:00:00.123Z" (RFC 3339)
std::string utc_text(Milliseconds time);

/// "Sat, 31 Jan 2026 12:00:00 GMT" (RFC 9110 5.6.7), for headers of HTTP.
std::string http_date(Milliseconds time);

/// The inverse of utc_text: any date-time of RFC 3339 5.6, with any offset; fractions are cut to milliseconds.
std::optional<Milliseconds> utc_time(const std::string& text);

}  // namespace talus::service

#pragma once
// Time as records keep it.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace talus::service {

/// Milliseconds since 1970, UTC.
using Milliseconds = std::int64_t;
/// Where the time comes from; tests bring their own.
using Clock = std::function<Milliseconds()>;

Milliseconds system_now();

/// "2026-01-31T12:00:00.123Z" (RFC 3339)
std::string utc_text(Milliseconds time);

/// "Sat, 31 Jan 2026 12:00:00 GMT" (RFC 9110 5.6.7), as HTTP wants it.
std::string http_date(Milliseconds time);

/// The inverse of utc_text: any date-time of RFC 3339 5.6, with any offset; fractions are cut to milliseconds.
std::optional<Milliseconds> utc_time(std::string_view text);

}  // namespace talus::service

#pragma once
// Time as records keep it.

#include <cstdint>
#include <functional>
#include <string>

namespace talus::service {

/// Milliseconds since 1970, UTC.
using Milliseconds = std::int64_t;
/// Where the time comes from; tests bring their own.
using Clock = std::function<Milliseconds()>;

Milliseconds system_now();

/// "2026-01-31T12:00:00.123Z" (RFC 3339)
std::string utc_text(Milliseconds time);

}  // namespace talus::service

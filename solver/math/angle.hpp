#pragma once
// Degrees and radians: the only place where one becomes the other.

#include <numbers>

namespace talus {

/// [deg] -> [rad]
constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }
/// [rad] -> [deg]
constexpr double degrees(double radians) { return radians * (180.0 / std::numbers::pi); }

}  // namespace talus

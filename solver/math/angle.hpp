#pragma once
// Degrees and radians: the only place where one becomes the other.

#include <cmath>
#include <numbers>

namespace talus {

/// [deg] -> [rad]
constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }
/// [rad] -> [deg]
constexpr double degrees(double radians) { return radians * (180.0 / std::numbers::pi); }
/// The friction angle of a soil. [-] -> [deg]
inline double friction_angle_deg(double tan_phi) { return degrees(std::atan(tan_phi)); }

}  // namespace talus

#pragma once
// The thickness of the deposit, and how far it reaches with a given one.

#include <optional>
#include <span>

namespace talus {

/// Soil of one particle as the thickness sees it.
struct SoilParcel {
  double run_out;  ///< distance along the run-out axis [m]
  double area;     ///< mass over reference density: what the soil takes up when it is not loosened [m2]
};

/// Thickness of the soil at the run-out s, measured vertically as between two surveys; the normal thickness on a slope
/// of angle theta is cos(theta) times that:
///   T(s) = sum_j A_j w(s - s_j),  w(d) = 15/(16 R) (1 - (d/R)^2)^2 for |d| < R, R = 3 spacings.
/// T is smooth, exact to 0.1 % for soil of constant or linear thickness over R, and its integral is the area of the
/// soil.
/// @param parcels  in increasing order of run_out
/// @param spacing  of the particles [m], > 0
/// @return [m]. Pure; thread-safe.
double thickness(std::span<const SoilParcel> parcels, double spacing, double s);

/// Farthest run-out at which the soil is at least `least` thick, T(s) = least [m]; unset if it is nowhere that thick.
/// As T is smooth, the front moves continuously with the particles and not by whole spacings.
/// @param parcels  in increasing order of run_out
/// @param spacing  of the particles [m], > 0
/// @param least    [m], > 0; below 1.5 spacings a single row of particles may decide it
/// Pure; thread-safe.
std::optional<double> front_at_thickness(std::span<const SoilParcel> parcels, double spacing, double least);

}  // namespace talus

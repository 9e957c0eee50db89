#pragma once
// Fixed particles that fill the rock behind the wall line, [Z20] 2.1 and method of Takeda 1994, Morris 1997.

#include <cstdint>
#include <vector>

#include "particles/geometry.hpp"

namespace talus {

/// A wall particle: where it stands and the piece of wall it stands behind.
struct WallPoint {
  Vec2 x;                 ///< [m]
  Vec2 n;                 ///< unit normal of the wall there, towards the soil
  double depth;           ///< distance to the wall line [m], > 0
  std::int32_t boundary;  ///< index into Model::boundaries
};

/// Lines the wall with `layers` rows of particles at depths (k + 1/2) dx, spaced dx along each row.
/// @param boundary  index that the points are given
std::vector<WallPoint> fill_walls(const Polyline& wall, double dx, int layers, std::int32_t boundary = 0);

}  // namespace talus

#pragma once
// The load of the soil on a boundary.

#include <cstdint>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// Force of the soil on a boundary per metre of width, and its moment about a point, counter-clockwise.
struct WallLoad {
  Vec2 force;           ///< [N/m]
  double moment = 0.0;  ///< [N m/m]

  WallLoad& operator+=(const WallLoad& b) {
    force += b.force;
    moment += b.moment;
    return *this;
  }
  bool operator==(const WallLoad&) const = default;
};
inline WallLoad operator*(double s, const WallLoad& load) { return {s * load.force, s * load.moment}; }

/// A boundary whose load is asked for.
struct LoadedBoundary {
  std::int32_t boundary = 0;  ///< index into Model::boundaries
  Vec2 about;                 ///< point of the moment [m]
  bool operator==(const LoadedBoundary&) const = default;
};

}  // namespace talus

#pragma once
// Targets: the places of a case whose fate is observed.

#include <optional>

#include "math/vec2.hpp"
#include "support/targets.hpp"

namespace talus {

/// What a target that is a rigid obstacle has besides.
struct Structure {
  int boundary = 0;        ///< index into Model::boundaries
  Vec2 foot;               ///< where its face on the side to which the slide goes meets the ground [m]
  double averaging = 0.1;  ///< forces are means over this time [s], > 0
  bool operator==(const Structure&) const = default;
};

/// A place that is observed.
struct Target {
  TargetName of;
  double from = 0.0, to = 0.0;  ///< x between which the flow is observed, from <= to; equal for a single place [m]
  double threshold = 0.1;       ///< thickness of flow with which the slide arrives [m], > 0
  std::optional<Structure> structure = {};
  bool operator==(const Target&) const = default;
};

}  // namespace talus

#pragma once
// Plane geometry of polylines and outlines for the checks of a case.

#include <optional>
#include <span>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// Two edges of a polyline that cross or touch; edge k runs from vertex k to the next.
struct EdgePair {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// The first pair of edges that cross, touch or fold back on one another; neighbours may share their vertex.
std::optional<EdgePair> self_intersection(std::span<const Vec2> vertices, bool closed);

/// The soil between a ground surface and a slip surface below it: one outline for each connected piece of
/// { slip < y < ground }, counter-clockwise from its leftmost vertex. Both surfaces run left to right.
std::vector<std::vector<Vec2>> between_surfaces(std::span<const Vec2> ground, std::span<const Vec2> slip);

/// Height of the bed beneath a point: of its highest crossing with the vertical through the point that does not lie
/// above the point; of the point itself where there is none. [m]
double height_beneath(std::span<const Vec2> bed, Vec2 point);

/// A point of the outline that lies on the wrong side of the ground, and how deep. [m]
struct Penetration {
  Vec2 at;
  double depth = 0.0;
};

/// How far an outline reaches out of a ring of ground, or the thickness of the rock inside it; depth 0 where it does
/// neither.
Penetration reach_outside_ring(std::span<const Vec2> outline, std::span<const Vec2> ring);

/// The room above an open bed as a ring: the bed, and up from its ends to above `top`. [m]
std::vector<Vec2> room_above(std::span<const Vec2> bed, double top);

}  // namespace talus

#pragma once
// What of an outline lies inside another ring: areas that hold wherever the edges lie, and the pieces.

#include <optional>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"

namespace talus {

/// Area of an outline inside and outside a ring. [m2]
struct AreaSplit {
  double inside = 0.0;
  double outside = 0.0;
};

/// Summed over the strips between neighbouring vertices, to rounding: edges may lie on one another. Both are simple, of
/// either orientation.
AreaSplit split_area(std::span<const Vec2> outline, std::span<const Vec2> ring);

/// Area that two outlines share. [m2]
double shared_area(std::span<const Vec2> a, std::span<const Vec2> b);

using Pieces = std::vector<std::vector<Vec2>>;

/// The parts of an outline inside a ring, or outside it, counter-clockwise. Each try of the overlay is compared with
/// split_area, because the overlay may fail where edges lie on one another to rounding.
/// @return nothing where no try succeeds, or where a piece would have a hole
std::optional<Pieces> pieces_inside(std::span<const Vec2> outline, std::span<const Vec2> ring);
std::optional<Pieces> pieces_outside(std::span<const Vec2> outline, std::span<const Vec2> ring);

/// Vertical thickness of a slide over a strip, linear between its sides. [m]
struct ThicknessStrip {
  double x0, x1;
  double at_x0, at_x1;
};

/// The strips between neighbouring vertices of a slide from left to right; 0 in the gaps between its parts.
std::vector<ThicknessStrip> thickness_strips(std::span<const SlidePart> slide);

}  // namespace talus

#pragma once
// Axes along and across a bedding that dips.

#include <cmath>
#include <span>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// Coordinates turned by the dip a: x' = x cos a - y sin a along the bedding, which falls towards +x for a > 0, and
/// y' = x sin a + y cos a across it.
class Bedding {
 public:
  /// @param dip  [rad]
  explicit Bedding(double dip) : level_(dip == 0), cosine_(std::cos(dip)), sine_(std::sin(dip)) {}

  Vec2 turned(Vec2 p) const { return level_ ? p : Vec2{p.x * cosine_ - p.y * sine_, p.x * sine_ + p.y * cosine_}; }
  std::vector<Vec2> turned(std::span<const Vec2> points) const {
    std::vector<Vec2> out;
    out.reserve(points.size());
    for (const Vec2 p : points) out.push_back(turned(p));
    return out;
  }
  /// The smallest rectangle along these axes that holds a box.
  Box around(Box box) const {
    const Vec2 corner = turned(box.lo);
    Box out{corner, corner};
    for (const Vec2 p : {Vec2{box.hi.x, box.lo.y}, box.hi, Vec2{box.lo.x, box.hi.y}}) out.include(turned(p));
    return out;
  }

 private:
  bool level_;
  double cosine_, sine_;
};

}  // namespace talus

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/geometry.hpp"
#include "sph/packed.hpp"

namespace talus {

/// Where each soil particle started, by id; kept in eight bytes, to 2^-30 of the slide's extent.
class StartingPositions {
 public:
  StartingPositions(std::span<const SoilPoint> points, Box slide)
      : grid_{slide.lo, std::max(slide.width(), slide.height()) / static_cast<double>(1 << 30)} {
    positions_.reserve(points.size());
    for (const SoilPoint& p : points) positions_.push_back({quanta(p.x.x - grid_.lo.x), quanta(p.x.y - grid_.lo.y)});
  }

  /// [m]
  Vec2 operator[](std::int32_t id) const {
    const auto& at = positions_.at(static_cast<std::size_t>(id));
    return grid_.lo + grid_.quantum * Vec2{static_cast<double>(at[0]), static_cast<double>(at[1])};
  }

 private:
  std::int32_t quanta(double distance) const {
    return static_cast<std::int32_t>(std::lround(distance / grid_.quantum));
  }

  FixedPoint grid_;
  std::vector<std::array<std::int32_t, 2>> positions_;
};

}  // namespace talus

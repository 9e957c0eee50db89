#pragma once
// What a simulation remembers of its particles besides their state.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "particles/fill.hpp"
#include "particles/particles.hpp"
#include "simulation/model.hpp"
#include "sph/packed_flow.hpp"

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

/// The stop-at-rest rule of a run: the slide rests once its root-mean-square speed has stayed below a limit for long
/// enough.
class RestRule {
 public:
  explicit RestRule(std::optional<StopAtRest> limits) : limits_(limits) {}

  bool active() const { return limits_.has_value(); }
  /// @param rms_speed  root-mean-square speed of the soil [m/s] at `time` [s]
  void observe(double time, double rms_speed) {
    if (rms_speed >= limits_->speed)
      slow_since_.reset();
    else if (!slow_since_)
      slow_since_ = time;
  }
  bool rests(double time) const { return slow_since_ && time - *slow_since_ >= limits_->hold; }

  /// Time since which the slide has been slower than the limit [s]; unset: it is not. For checkpoints.
  std::optional<double> slow_since() const { return slow_since_; }
  void restore(std::optional<double> slow_since) { slow_since_ = slow_since; }

 private:
  std::optional<StopAtRest> limits_;
  std::optional<double> slow_since_;
};

}  // namespace talus

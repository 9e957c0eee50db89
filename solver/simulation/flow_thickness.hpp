#pragma once
// How thick a slide is while it moves.

#include <array>
#include <optional>
#include <span>

#include "material/material.hpp"
#include "particles/particles.hpp"

namespace talus {

/// Mean thickness of a slide along its way, in spacings: over time and over the soil, each part counted by its
/// momentum. Thickness is measured vertically, in columns four spacings wide, of the volume at the reference density.
/// The bits do not depend on the number of threads. Not thread-safe.
class FlowThickness {
 public:
  /// Counts the soil that takes part for the time since the observation before.
  /// @param materials  of the soil, by index
  /// @param dx         particle spacing [m]
  /// @param time       [s], not earlier than that of the observation before
  void observe(const Soil& soil, std::span<const Material> materials, double dx, double time);

  /// [dx]; unset: nothing has moved yet
  std::optional<double> mean() const { return sums_[0] > 0.0 ? std::optional(sums_[1] / sums_[0]) : std::nullopt; }

  /// All that it remembers, for checkpoints.
  std::array<double, 3> state() const { return {sums_[0], sums_[1], time_}; }
  void restore(const std::array<double, 3>& state) {
    sums_ = {state[0], state[1]};
    time_ = state[2];
  }

 private:
  std::array<double, 2> sums_{};  ///< integral over time of momentum [kg s/m], of momentum times thickness
  double time_ = 0.0;             ///< of the last observation [s]
};

}  // namespace talus

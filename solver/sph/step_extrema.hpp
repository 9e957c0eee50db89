#pragma once

#include <algorithm>
#include <limits>

namespace talus {

/// Extrema over the soil particles after a time step: input to the CFL condition, to the upkeep of the neighbour lists
/// and to the divergence check.
struct StepExtrema {
  double max_displacement = 0.0;  ///< largest displacement in this step [m]
  double max_acceleration = 0.0;  ///< largest |a| of the last evaluation [m/s2]
  double max_speed = 0.0;         ///< largest |v| after the step [m/s]
  double moved_since_sort = 0.0;  ///< largest displacement since the last sort [m]
  double leftmost = std::numeric_limits<double>::infinity();
  double rightmost = -std::numeric_limits<double>::infinity();  ///< smallest and largest x after the step [m]
  bool all_finite = true;                                       ///< every value is finite, every density positive

  /// The extrema of both sets of particles.
  StepExtrema merge(const StepExtrema& b) const {
    return {std::max(max_displacement, b.max_displacement),
            std::max(max_acceleration, b.max_acceleration),
            std::max(max_speed, b.max_speed),
            std::max(moved_since_sort, b.moved_since_sort),
            std::min(leftmost, b.leftmost),
            std::max(rightmost, b.rightmost),
            all_finite && b.all_finite};
  }
};

}  // namespace talus

#pragma once

#include <optional>

#include "simulation/model.hpp"

namespace talus {

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

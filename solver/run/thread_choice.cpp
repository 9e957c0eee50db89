#include "run/thread_choice.hpp"

#include <algorithm>

namespace talus {
namespace {

// A trial of half the threads costs an idle machine half a window: 1 % of a short run, less of a long one.
constexpr double first_interval = 0.5, longest_interval = 10.0;  ///< wall clock between trials [s]
constexpr double least_window = 0.05;                            ///< wall clock of a measurement [s]
constexpr int least_steps = 10;                                  ///< steps of a measurement
constexpr double clearly_faster = 0.9;  ///< the trial wins if its steps take less than this share of the time

}  // namespace

ThreadChoice::ThreadChoice(std::size_t particles, int cores, std::optional<int> given)
    : most_(static_cast<int>(
          std::clamp<std::size_t>(particles / particles_per_thread, 1, static_cast<std::size_t>(cores)))),
      current_(given.value_or(most_)),
      most_used_(current_),
      fixed_(given.has_value() || most_ == 1),
      until_trial_(first_interval),
      trial_interval_(first_interval) {}

void ThreadChoice::record(double seconds) {
  if (fixed_) return;
  until_trial_ -= seconds;
  window_ += seconds;
  ++window_steps_;
  if (window_ < least_window || window_steps_ < least_steps) return;
  end_window(window_ / window_steps_);
  window_ = 0.0;
  window_steps_ = 0;
}

void ThreadChoice::end_window(double mean_step) {
  if (trial_) {
    const bool won = mean_step < clearly_faster * current_step_;
    if (won) current_ = *trial_;
    trial_interval_ = won ? first_interval : std::min(2.0 * trial_interval_, longest_interval);
    until_trial_ = trial_interval_;
    trial_.reset();
  } else if (until_trial_ <= 0.0) {
    current_step_ = mean_step;
    begin_trial();
  }
}

void ThreadChoice::begin_trial() {
  const bool fewer = current_ == most_ || (current_ > 1 && try_fewer_);
  try_fewer_ = !fewer;
  trial_ = fewer ? current_ / 2 : std::min(2 * current_, most_);
  most_used_ = std::max(most_used_, *trial_);
}

}  // namespace talus

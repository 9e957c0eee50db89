#pragma once
// How many threads a run uses.

#include <cstddef>
#include <optional>

namespace talus {

/// As many threads as pay: at most one for every `particles_per_thread`, and no more than there are cores. While the
/// run goes on, it tries half or twice as many from time to time and keeps what is faster: on a busy machine, threads
/// that wait for each other can be slower than one. The bits of a run do not depend on it. Not thread-safe.
class ThreadChoice {
 public:
  /// Two threads on two idle cores: 1.3 times as fast with 1,000 particles, 1.8 times with 2,000 and with 4,000.
  /// Cautious, since on a busy machine threads that wait for one another lose more than that.
  static constexpr std::size_t particles_per_thread = 2000;

  /// @param particles  soil and walls
  /// @param cores      that the process may use, >= 1
  /// @param given      a number that the user wants, >= 1: it never changes
  ThreadChoice(std::size_t particles, int cores, std::optional<int> given = {});

  /// Threads for the next step, >= 1.
  int count() const { return trial_.value_or(current_); }
  /// The largest number so far.
  int most_used() const { return most_used_; }
  /// To be called after every step, with its wall clock [s].
  void record(double seconds);

 private:
  void end_window(double mean_step);
  void begin_trial();

  int most_, current_, most_used_;
  bool fixed_;
  std::optional<int> trial_;     ///< the number on trial
  bool try_fewer_ = true;        ///< in the next trial, if more would be possible too
  double current_step_ = 0.0;    ///< mean step with `current_` threads, in the window before the trial [s]
  double until_trial_ = 0.0;     ///< wall clock until the next trial [s]
  double trial_interval_ = 0.0;  ///< [s]
  double window_ = 0.0;          ///< wall clock of the window so far [s]
  int window_steps_ = 0;
};

}  // namespace talus

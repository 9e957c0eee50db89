#pragma once
// Ends a process that takes too long or hangs.

#include <chrono>
#include <optional>
#include <string>

#include "executor/process.hpp"

namespace talus::executor {

/// The CPU time that a process of this machine and its threads have used so far [s], from /proc/PID/stat; unset where
/// that cannot be read.
std::optional<double> cpu_seconds_of(pid_t pid);

/// The watch over one process; to be asked often. A process that has used no CPU time for `limits.stall_seconds` hangs
/// (it was stopped, or waits for what never comes): it is continued and asked to end (SIGCONT, SIGTERM), and killed
/// `patience` later. One that runs longer than `limits.wall_seconds` is killed. Not thread-safe.
class Watch {
 public:
  using Clock = std::chrono::steady_clock;
  /// From asking a process to end to killing it.
  static constexpr std::chrono::seconds patience{5};  ///< at most the limit itself

  explicit Watch(const Limits& limits) : limits_(limits) {}

  /// Looks at the process, which has not ended, and sends it what it deserves.
  void look(const Process& process);
  /// It took longer than its limit.
  bool timed_out() const { return timed_out_; }
  /// Why a hanging process was ended, in one line; empty if it was not.
  const std::string& why() const { return why_; }

 private:
  bool hangs(const Process& process, Clock::time_point now);

  Limits limits_;
  Clock::time_point begin_ = Clock::now(), read_at_ = begin_;
  Clock::duration idle_{};  ///< since the CPU time last grew
  std::optional<double> cpu_seconds_;
  std::optional<Clock::time_point> kill_at_;
  bool timed_out_ = false;
  std::string why_;
};

}  // namespace talus::executor

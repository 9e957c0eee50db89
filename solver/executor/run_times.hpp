#pragma once
// How long runs take, and how many of them an array task should get.

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace talus::executor {

/// Mean time of the runs of each group.
class RunTimes {
 public:
  /// A run of the group has ended after so many seconds.
  void ended(const std::string& group, double seconds);
  /// A run of the group has been running for so many seconds.
  void still_runs(const std::string& group, double seconds);
  /// The mean duration [s]; while no run has ended, the longest time that one has been running if that is at least 10
  /// s.
  std::optional<double> of(const std::string& group) const;

 private:
  struct Sum {
    double seconds = 0.0, longest = 0.0;
    std::size_t runs = 0;
  };
  std::map<std::string, Sum> groups_;
};

/// Number of runs of one array task: enough that the start of the task (about 1 s) costs little, no more than take
/// `task_s`, and within that few enough that all free tasks get some.
/// @param runs    that wait
/// @param free    array tasks that may be begun, >= 1
/// @param run_s   time of a run; unset: not known yet, and each run is a task
std::size_t chunk_size(std::size_t runs, std::size_t free, std::optional<double> run_s, double task_s);

}  // namespace talus::executor

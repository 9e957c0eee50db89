#include "executor/run_times.hpp"

#include <algorithm>
#include <cmath>

namespace talus::executor {
namespace {

constexpr double worth_a_task_s = 10.0;  ///< the start of a task is then a tenth of it
constexpr std::size_t most_runs_of_task = 5000;

std::size_t runs_in(double seconds, double run_s) {
  return static_cast<std::size_t>(
      std::clamp(std::ceil(seconds / std::max(run_s, 1e-3)), 1.0, double{most_runs_of_task}));
}

}  // namespace

void RunTimes::ended(const std::string& group, double seconds) {
  Sum& sum = groups_[group];
  sum.seconds += seconds;
  ++sum.runs;
}

void RunTimes::still_runs(const std::string& group, double seconds) {
  Sum& sum = groups_[group];
  sum.longest = std::max(sum.longest, seconds);
}

std::optional<double> RunTimes::of(const std::string& group) const {
  const auto at = groups_.find(group);
  if (at == groups_.end()) return std::nullopt;
  const Sum& sum = at->second;
  if (sum.runs > 0) return sum.seconds / static_cast<double>(sum.runs);
  return sum.longest >= worth_a_task_s ? std::optional(sum.longest) : std::nullopt;
}

std::size_t chunk_size(std::size_t runs, std::size_t free, std::optional<double> run_s, double task_s) {
  if (!run_s) return 1;
  const std::size_t least = runs_in(std::min(worth_a_task_s, task_s), *run_s), most = runs_in(task_s, *run_s);
  const std::size_t size = std::clamp((runs + free - 1) / free, least, most);
  const std::size_t tasks = std::max<std::size_t>(1, (runs + size - 1) / size);
  return std::max<std::size_t>(1, (runs + tasks - 1) / tasks);  // all of them equally long
}

}  // namespace talus::executor

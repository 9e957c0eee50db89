#pragma once
// Checked readers of the output of Slurm's programs.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace talus::executor {

/// An array task in the reply of squeue.
struct QueuedTask {
  std::string state;  ///< Slurm's word: "PENDING", "NODE_FAIL"
  bool alive = true;  ///< it waits or runs, or Slurm will requeue it
  bool running = false;
  std::string reason = {};  ///< why it waits, Slurm's word: "Resources", "JobHeldUser"; empty where it gives none
};

/// The whole queue at one moment.
class SlurmQueue {
 public:
  /// @param json  output of `squeue --json` of Slurm 22.05 or newer
  /// @throws IoError naming the place
  explicit SlurmQueue(const std::string& json);

  /// Unset if Slurm does not know the task: never submitted, or ended long ago.
  std::optional<QueuedTask> task(std::int64_t array_job, std::int64_t index) const;
  /// The array job of this name.
  std::optional<std::int64_t> job_named(const std::string& name) const;

 private:
  struct Waiting {
    QueuedTask task;
    std::optional<std::set<std::int64_t>> indices;  ///< unset: all that have no record of their own
  };
  std::map<std::pair<std::int64_t, std::int64_t>, QueuedTask> tasks_;  ///< by array job and index
  std::map<std::int64_t, Waiting> waiting_;  ///< those that Slurm keeps together, by array job
  std::map<std::string, std::int64_t> names_;
};

/// The job of sbatch's answer: "123" or "123;cluster".
/// @throws IoError
std::int64_t parse_job_id(const std::string& answer);

/// "0-2,5,7-11:2%4" as numbers; nothing where it is cut short with dots or cannot be understood.
std::optional<std::set<std::int64_t>> parse_indices(const std::string& text);

}  // namespace talus::executor

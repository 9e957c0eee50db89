#pragma once
// The runs of one array job, in a directory that all machines see:
//
//   task.sh      the job script: executes its arguments
//   I.json       the runs of array task I, one after the other
//   I-P.status   how run P of it ended
//   I-P.kill     run P is to be killed
//   I.log        stdout and stderr of the task
//   job          the number of the array job
//
// Every file is written atomically. Once the directory is removed, tasks that start later find nothing to do.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "executor/executor.hpp"

namespace talus::executor {

/// How a run ended on its machine.
struct RunStatus {
  ProcessEnd end = {};
  double seconds = 0.0;  ///< wall clock of this process
  bool resumed = false;
  bool timed_out = false;
  std::string why = {};  ///< why it could not be started, or was ended as hanging
};

/// A run of a batch by array task and place in it.
struct RunPlace {
  std::size_t task = 0, position = 0;
  auto operator<=>(const RunPlace&) const = default;
};

class BatchDirectory {
 public:
  explicit BatchDirectory(std::filesystem::path path) : path_(std::move(path)) {}
  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path script() const { return path_ / "task.sh"; }
  /// Creates it, with the script and the runs of every array task. @throws IoError
  void write(const std::vector<std::vector<Run>>& tasks) const;
  /// The runs of an array task; nothing where there is no such file. @throws IoError
  std::optional<std::vector<Run>> runs(std::size_t task) const;

  /// @throws IoError
  void write_status(RunPlace run, const RunStatus& status) const;
  bool has_status(RunPlace run) const;
  /// @throws IoError
  RunStatus status(RunPlace run) const;
  /// The runs that have a status, in order; none where there is no directory.
  /// @throws IoError when it cannot be read
  std::vector<RunPlace> statuses() const;

  void want_killed(RunPlace run) const;
  bool is_killed(RunPlace run) const;

  void write_job(std::int64_t job) const;
  /// Unset if the file is missing or does not hold a number.
  std::optional<std::int64_t> job() const;

 private:
  std::filesystem::path file(RunPlace run, std::string_view ending) const;
  std::filesystem::path path_;
};

/// What an array task of Slurm does on its machine: executes the runs of task $SLURM_ARRAY_TASK_ID of a batch, one
/// after the other; those that have a status were executed before Slurm started the task again. A SIGTERM is passed on
/// to the run, which leaves a checkpoint; then it ends, and the runs without a status are for another task.
/// @return 0, also where there was nothing to do or it was asked to stop; 2 outside an array task
/// @throws IoError
int execute_array_task(const BatchDirectory& batch);

}  // namespace talus::executor

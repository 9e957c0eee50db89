#pragma once
// Execution of solver runs on this machine or by Slurm. `talus study` and talusd know only this interface.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "executor/process.hpp"

namespace talus::executor {

/// One run: a program that writes into its own directory, leaves checkpoint.h5 there (exit code 6) when it gets a
/// SIGTERM, and continues from it with `--resume`.
struct Run {
  std::string name;   ///< unique among open runs, and unchanged after a restart of this process
  std::string group;  ///< runs of one group take about as long as each other
  Command command;    ///< paths are absolute
  std::filesystem::path directory;
  std::filesystem::path log;
};

using RunId = std::int64_t;

/// How a run ended.
struct Ended {
  RunId id = 0;
  ProcessEnd end = {};
  bool resumed = false;    ///< it began from a checkpoint
  bool timed_out = false;  ///< killed, since it took longer than its limits.wall_seconds
  bool preempted = false;  ///< preempted or lost with its node; not counted as an attempt, `end` is meaningless
  std::string why = {};    ///< reason in one line, if the process did not end by itself
};

/// Not thread-safe: all calls come from one thread.
class Executor {
 public:
  virtual ~Executor() = default;
  /// Whether another run can be started now.
  virtual bool has_room() const = 0;
  /// Starts a run; its directory may contain the remains of an earlier attempt. poll() reports its end exactly once.
  /// @throws IoError
  virtual RunId start(const Run& run) = 0;
  /// The runs that ended since the last call; never blocks.
  /// @throws IoError when runs cannot be executed at all; a later call tries again
  virtual std::vector<Ended> poll() = 0;
  /// Asks all runs to write a checkpoint and end.
  virtual void stop_all() = 0;
  /// Ends a run.
  virtual void kill(RunId id) = 0;
  /// Why no run of this group is in progress, one line; empty while one is, or if the reason is unknown.
  virtual std::string pending_reason(const std::string& group) const = 0;
  /// Runs continue when this process ends; a later process that starts a run of the same name adopts it.
  virtual bool outlives_this_process() const = 0;
};

/// Runs as processes of this machine, at most `most_workers` at a time. The destructor kills all of them.
std::unique_ptr<Executor> make_local_executor(int most_workers);

}  // namespace talus::executor

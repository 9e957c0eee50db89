#pragma once
// Runs as array jobs of Slurm. Scheduling is left to Slurm: it decides where and when, restarts tasks of lost or
// preempted nodes, and ends tasks at their time limit.
//
// Runs wait here until the next poll, then go out as one array job, each task with a chunk of them. Their ends come
// back as status files on the shared directory; the queue (one squeue for all) is asked only which tasks are still to
// be waited for. A run whose task is gone without a status is lost and reported as such.

#include <chrono>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <optional>

#include "executor/executor.hpp"
#include "executor/run_times.hpp"
#include "executor/slurm_batch.hpp"
#include "executor/slurm_config.hpp"
#include "executor/slurm_queue.hpp"

namespace talus::executor {

class SlurmExecutor final : public Executor {
 public:
  using Note = std::function<void(const std::string&)>;

  /// @param directory   for batches; seen by all machines under this path
  /// @param array_task  command that executes an array task; gets the directory of the batch as one more argument
  /// @param threads     of each run
  /// @param note        called with what an operator should know
  SlurmExecutor(SlurmConfig config, std::filesystem::path directory, std::vector<std::string> array_task, int threads,
                Note note);

  bool has_room() const override;
  RunId start(const Run& run) override;
  std::vector<Ended> poll() override;
  void stop_all() override;
  void kill(RunId id) override;
  std::string pending_reason(const std::string& group) const override;
  bool outlives_this_process() const override { return true; }

 private:
  using Steady = std::chrono::steady_clock;

  struct Entry {
    Run run;
    RunId id = 0;  ///< 0: of an earlier process, not adopted yet
    bool ended = false, killed = false;
    bool told = false;  ///< that its status cannot be read
  };
  struct Task {
    std::vector<Entry> entries;
    int missed = 0;  ///< consecutive polls of the queue that did not find it
    std::optional<Steady::time_point> running_since = {};
    std::string reason = {};  ///< Slurm's word for why it waits
    bool over = false;        ///< it writes nothing any more
    bool unwanted = false;
  };
  struct Batch {
    BatchDirectory directory;
    std::optional<std::int64_t> job = {};  ///< unset: sbatch has not answered
    std::vector<Task> tasks = {};
    Steady::time_point since = {};  ///< it is in Slurm's queue at the latest since then
  };
  /// One of Slurm's programs at work.
  struct Call {
    Process process;
    std::filesystem::path out, err;
    Steady::time_point begin;
  };
  struct Place {
    Batch* batch;
    RunPlace run;
  };

  // slurm.cpp: starting runs, and the poll cycle
  void poll_cycle();
  void collect(Batch& batch);
  void take_in(Batch& batch, RunPlace place);
  void reconcile(Batch& batch);
  void mark_lost(Batch& batch, std::size_t index, const std::string& state);
  void end(Entry& entry, Ended how);
  void drop_finished();
  Entry& entry(const Place& place) { return place.batch->tasks[place.run.task].entries[place.run.position]; }
  std::size_t open_tasks() const;
  void estimate_load(const Run& run, bool waits);
  void estimate_all_load();
  // slurm.cpp: what an earlier process left
  void recover();
  void recover(const std::filesystem::path& path);
  void drop_unclaimed();
  bool take_over(const Run& run, RunId id);
  // slurm_calls.cpp: Slurm's programs
  void end_calls();
  static std::string answer(const Call& call, const ProcessEnd& end);
  void submitted(const Call& call, const ProcessEnd& end);
  void not_submitted(const std::string& why);
  void queue_seen(const Call& call, const ProcessEnd& end);
  void submit();
  std::vector<std::vector<Entry>> next_tasks(std::size_t free);
  std::vector<std::string> sbatch_arguments(const BatchDirectory& batch, std::size_t tasks) const;
  void ask_queue();
  void cancel_unwanted();
  Call call(std::vector<std::string> arguments) const;

  SlurmConfig config_;
  std::filesystem::path directory_;
  std::vector<std::string> array_task_;
  int threads_;
  Note note_;
  Steady::duration poll_;

  RunId last_ = 0;
  std::deque<Entry> waiting_;
  std::list<Batch> batches_;
  std::map<RunId, Place> open_;
  std::map<std::string, Place> unclaimed_;  ///< runs that an earlier process submitted, by name
  Steady::time_point recovered_;
  RunTimes times_;
  std::vector<Ended> ended_;
  double load_ = 0.0;        ///< array tasks that are open, or that the waiting runs will need
  std::size_t unknown_ = 0;  ///< runs of unknown duration

  std::optional<Call> sbatch_, squeue_, scancel_;
  Batch* submitting_ = nullptr;      ///< what sbatch_ is about
  std::optional<SlurmQueue> queue_;  ///< empty before the first poll
  Steady::time_point queue_begun_{}, next_cycle_{}, next_queue_{}, next_submit_{}, next_cancel_{};
  int refusals_ = 0;             ///< consecutive refusals of sbatch
  bool answered_since_ = false;  ///< squeue worked since the first of them
  bool away_ = false;            ///< squeue does not work
  bool stopping_ = false;
};

}  // namespace talus::executor

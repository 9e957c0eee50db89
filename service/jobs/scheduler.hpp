#pragma once
// Runs what the queue holds: one thread that starts workers, watches them and writes down how they end.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "executor/executor.hpp"
#include "jobs/changes.hpp"
#include "jobs/commands.hpp"
#include "queue/store.hpp"

namespace talus::service {

/// Numbers for /metrics.
struct WorkDone {
  std::atomic<std::int64_t> done{0}, failed{0}, crashed{0}, given_back{0}, stale{0};
  std::atomic<std::int64_t> wall_clock_ms{0};  ///< of the done ones
  std::atomic<int> running{0};
  std::atomic<int> orphans{0};  ///< directories put aside at start
};

class Scheduler {
 public:
  Scheduler(const Config& config, Store& store, Changes& changes);
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Puts back what an earlier talusd held, puts directories of no known job aside, and starts to work.
  void start();
  /// Stops claiming, asks the workers to checkpoint, puts their runs back; kills what has not ended within the grace.
  void drain();
  /// Something has changed: read the queue now, and check whether the leases still hold.
  /// @param dismissed  a job has been dismissed, whose directory can go
  void wake(bool dismissed = false);
  const WorkDone& work_done() const { return done_; }

 private:
  using Steady = std::chrono::steady_clock;

  struct Worker {
    Claim claim;
    StudyDirectory study;
    std::optional<executor::Ended> how = {};  ///< it has ended, but that may not be written down yet
    bool lost = false;                        ///< its claim is not current any more
  };
  struct Publisher {
    Job job;
    StudyDirectory study;
    executor::Process process;
    Steady::time_point deadline;
    bool interim = false;
  };

  void loop();
  void tick();
  void end_workers();
  void beat();
  void reap();
  void reap_publishers();
  void settle(Worker& worker);
  void settle_result(Worker& worker);
  void settle_failure(Worker& worker, const RunFailure& failure);
  void settle_broken(Worker& worker, const RunFailure& failure, bool crashed);
  void fill();
  void start_worker(const Claim& claim);
  bool adopt(const Claim& claim, const StudyDirectory& study, const Job& job);
  void clear_work(const StudyDirectory& study, const RunKey& run);
  void publish_complete();
  void publish_interim();
  void note_waits();
  std::set<std::string> jobs_at_work() const;
  void start_publisher(const Job& job, bool interim);
  void settle_publisher(Publisher& publisher, executor::ProcessEnd end);
  void run_echo();
  void remove_dismissed();
  void put_orphans_aside();
  bool room_on_disk();
  void wait_for(std::chrono::milliseconds most);
  StudyDirectory study(const std::string& id) const { return {data_.job(id)}; }
  std::optional<Job> job_of(const Claim& claim) { return store_.job(claim.job_id); }

  const Config& config_;
  DataDirectory data_;
  Store& store_;
  Changes& changes_;
  Commands commands_;
  Milliseconds lease_;
  WorkDone done_;

  std::unique_ptr<executor::Executor> executor_;
  std::map<executor::RunId, Worker> workers_;
  std::list<Publisher> publishers_;
  std::map<std::int64_t, int> publish_failures_;            ///< by job
  std::set<std::string> waiting_;                           ///< jobs that say what they wait for
  std::map<std::int64_t, std::int64_t> interim_published_;  ///< by job: how many were done then
  Steady::time_point next_beat_{}, next_interim_{}, retry_at_{}, next_removal_{};
  bool look_ = true;  ///< the queue may hold something to do
  bool echo_waiting_ = false;
  bool told_trouble_ = false;
  bool removing_ = true;  ///< look for directories of dismissed jobs

  std::mutex mutex_;
  std::condition_variable wake_;
  bool woken_ = false, dismissed_ = false;
  std::atomic<bool> draining_{false}, stopped_{false};
  std::thread thread_;
};

}  // namespace talus::service

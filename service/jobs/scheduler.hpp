#pragma once
// One thread that carries out what the queue holds: the runs of studies by the engine, their statistics at the end, and
// echo jobs.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "jobs/changes.hpp"
#include "jobs/commands.hpp"
#include "jobs/data_directory.hpp"
#include "queue/store.hpp"
#include "study/engine.hpp"

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

  /// Requeues what an earlier talusd held, puts directories of no known job aside, and starts to work.
  void start();
  /// Stops claiming, asks the runs to checkpoint, requeues them; kills what has not ended within the grace.
  void drain();
  /// Something has changed: read the queue now, and check whether the leases still hold. Thread-safe.
  /// @param job  that has been dismissed, extended or retried, if one has
  void wake(std::optional<std::int64_t> job = {});
  const WorkDone& work_done() const { return done_; }

 private:
  using Steady = std::chrono::steady_clock;

  void loop();
  void tick();
  void wait_for(std::chrono::milliseconds most);
  void end_runs();
  EngineOptions engine_options();
  void count(const RunEvent& event);
  void finish_complete();
  void finish(const Job& job);
  void note_pending_reasons();
  void run_echo();
  void remove_dismissed();
  void put_orphans_aside();
  bool room_on_disk() const;

  const Config& config_;
  DataDirectory data_;
  Store& store_;
  Changes& changes_;
  Commands commands_;
  WorkDone done_;
  Engine engine_;

  std::set<StudyNumber> pending_;  ///< jobs that say why none of their runs is under way
  Steady::time_point next_renewal_{}, next_reasons_{}, next_removal_{};
  bool read_queue_ = true;  ///< the queue may hold something to do
  bool echo_waiting_ = false;
  bool told_trouble_ = false;
  bool removing_ = true;  ///< look for directories of dismissed jobs

  std::mutex mutex_;
  std::condition_variable wake_;
  bool woken_ = false;
  std::set<StudyNumber> changed_;  ///< studies that the engine must read anew
  std::atomic<bool> draining_{false}, stopped_{false};
  std::thread thread_;
};

}  // namespace talus::service

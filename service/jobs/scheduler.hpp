#pragma once
// The thread that carries out the queue: the runs of studies by the engine, their statistics at the end, and echo jobs.

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <thread>

#include "jobs/commands.hpp"
#include "queue/store.hpp"
#include "study/engine.hpp"

namespace talus::service {

/// Counts for /metrics, since talusd started.
struct RunCounters {
  std::array<std::atomic<std::int64_t>, 6> ended{};  ///< runs by RunEvent::Kind
  std::atomic<std::int64_t> wall_clock_ms{0};        ///< of the done ones
  std::atomic<int> running{0};                       ///< now
};

/// Wakes the requests that wait for a change of a job. Thread-safe.
class ChangeNotifier {
 public:
  void notify() {
    {
      const std::lock_guard lock(mutex_);
      ++count_;
    }
    changed_.notify_all();
  }
  std::uint64_t count() const {
    const std::lock_guard lock(mutex_);
    return count_;
  }
  /// Waits until the count differs from `seen`, at most for `limit`.
  void wait(std::uint64_t seen, std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, limit, [&] { return count_ != seen; });
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t count_ = 0;
};

class Scheduler {
 public:
  Scheduler(const Config& config, Store& store);
  ~Scheduler() { drain(); }
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Requeues the runs that an earlier talusd held, moves directories of unknown jobs aside, and starts the thread.
  /// @throws StorageError, std::filesystem::filesystem_error
  void start();
  /// Stops claiming, asks the runs to write a checkpoint, requeues them; kills those that have not ended within the
  /// grace period.
  void drain();
  /// Tells the thread and the waiting requests that the queue has changed. Thread-safe.
  /// @param job  that has been dismissed, extended or retried, if one has
  void wake(std::optional<std::int64_t> job = {});
  /// Why nothing can be run or recorded now, in one line: a full disk, a queue that cannot be written; empty: all is
  /// well. Thread-safe.
  std::string trouble() const;
  const RunCounters& counters() const { return counters_; }
  ChangeNotifier& changes() { return changes_; }

 private:
  using Steady = std::chrono::steady_clock;

  void loop();
  void tick();
  void wait_for(std::chrono::milliseconds limit);
  void end_runs();
  EngineOptions engine_options();
  void count(const RunEvent& event);
  bool finish_complete();
  bool finish(const Job& job);
  void note_pending_reasons();
  void run_echo();
  void remove_dismissed();
  void set_trouble(const std::string& why);
  void shrink_queue();
  std::chrono::milliseconds until_next_tick() const;
  void free_space();
  bool room_on_disk() const;

  const Config& config_;
  DataDirectory data_;
  Store& store_;
  ChangeNotifier changes_;
  RunCounters counters_;
  Engine engine_;

  std::set<StudyNumber> pending_;  ///< jobs with a recorded reason why none of their runs is under way
  Steady::time_point next_renewal_{}, next_reasons_{}, next_removal_{};
  bool read_queue_ = true;                                    ///< the queue may hold something to do
  Steady::time_point next_echo_ = Steady::time_point::max();  ///< when an echo job may be due; max: none waits
  bool removing_ = true;                                      ///< directories of dismissed jobs may be left
  bool shrinking_ = true;  ///< the database may hold pages that dismissed jobs have left

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::string trouble_;  ///< why the last tick failed, as the log says; empty: it did not
  bool woken_ = false;
  std::set<StudyNumber> changed_;  ///< studies that the engine must read again
  std::atomic<bool> draining_{false};
  std::thread thread_;
};

}  // namespace talus::service

#pragma once
// Threads for the handlers: each kind of work has its own, so that none keeps the others waiting.

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace talus::service {

struct LaneLimits {
  std::size_t threads;      ///< started as they are needed
  std::size_t places;       ///< of work under way and waiting
  std::size_t places_each;  ///< of them, for one subject
};

/// A queue of work and its threads. The next to start is the work of the subject with the least under way. Thread-safe.
class WorkLane {
 public:
  /// Starts one thread. @throws std::system_error where the system gives none
  explicit WorkLane(LaneLimits limits);
  ~WorkLane() { join(); }
  WorkLane(const WorkLane&) = delete;
  WorkLane& operator=(const WorkLane&) = delete;

  /// Does `work` soon, in another thread. @param work  must not throw
  /// @return false where there is no place
  bool submit(const std::string& subject, std::function<void()> work);
  /// Does what is left, and ends the threads. Nothing may be submitted any more.
  void join();

 private:
  struct Entry {
    std::string subject;
    std::function<void()> work;
  };
  struct Share {
    std::size_t places = 0, running = 0;
  };

  void add_thread_if_needed();
  void serve();
  Entry take();

  const LaneLimits limits_;
  std::mutex lock_;
  std::condition_variable changed_;
  std::deque<Entry> waiting_;
  std::map<std::string, Share> shares_;  ///< of the subjects that have places
  std::size_t taken_ = 0, idle_ = 0;
  std::vector<std::thread> threads_;
  bool ending_ = false;
};

}  // namespace talus::service

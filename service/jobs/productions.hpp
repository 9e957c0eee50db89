#pragma once
// Things that take a while to make and that several requests may ask for: profiles, fields, evaluations.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/shares.hpp"

namespace talus::service {

/// Makes each thing once for all requests that ask for it meanwhile, in threads of its own, some at a time. The next is
/// that of the subject with the fewest under way; ties go to the least recently served. Thread-safe.
class Productions {
 public:
  /// Whether nobody waits for the thing any more, or talusd stops. What makes it asks often, and then ends.
  using Abandoned = std::function<bool()>;
  using Make = std::function<std::string(const Abandoned&)>;

  struct Limits {
    int at_a_time = 1;        ///< threads, which are started when they are needed
    int waiting = 128;        ///< requests, whatever they ask for
    int waiting_of_one = 64;  ///< requests of one subject
  };

  explicit Productions(const Limits& limits);
  ~Productions();
  Productions(const Productions&) = delete;
  Productions& operator=(const Productions&) = delete;

  /// The thing of this name. An exception of `make` goes to all who wait; the next request tries again.
  /// @param patience  then the request is refused, and the thing is made on, for a client that asks again
  /// @throws Refusal unavailable: not ready yet, too many wait, or talusd stops
  std::string get(const std::string& name, const Caller& caller, std::chrono::milliseconds patience, Make make);

  /// All that is under way is abandoned, and nothing more is made.
  void stop();

 private:
  using Steady = std::chrono::steady_clock;

  struct Thing {
    std::string name, subject;  ///< the first that asked for it
    Make make;
    int waiting = 0;                     ///< requests
    Steady::time_point kept_until = {};  ///< without a request that waits
    bool done = false;
    std::string made = {};
    std::exception_ptr error = {};
  };
  struct Subject {
    int under_way = 0;         ///< things
    std::int64_t served = -1;  ///< the number of its last thing that was begun
    auto operator<=>(const Subject&) const = default;
  };
  using Things = std::deque<std::shared_ptr<Thing>>;

  std::shared_ptr<Thing> find_or_queue(const std::string& name, const Caller& caller, Make make);
  void start_thread();
  void work();
  Things::iterator next();
  void carry_out(const std::shared_ptr<Thing>& thing, std::unique_lock<std::mutex>& lock);
  bool is_abandoned(const std::shared_ptr<Thing>& thing);
  void forget(const std::shared_ptr<Thing>& thing);

  Limits limits_;
  Shares waiting_;
  std::mutex mutex_;
  std::condition_variable work_;
  std::condition_variable_any done_;
  std::map<std::string, std::shared_ptr<Thing>> things_;  ///< queued or under way, by name
  Things queue_;
  std::map<std::string, Subject> subjects_;
  std::int64_t served_ = 0;  ///< things that have been begun
  std::size_t idle_ = 0;     ///< threads
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace talus::service

#pragma once
// Answers that take a process to make, kept for who asks the same again.

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "base/json.hpp"

namespace talus::service {

/// However many ask for the same at one moment, it is made once.
class LatestAnswers {
 public:
  /// @param version  of what the answer is about
  /// @param max_age  an answer of another version will do for so long
  /// @param make     called if there is none; what it throws goes to the caller, and the next one tries again
  Json get(const std::string& key, std::int64_t version, std::chrono::milliseconds max_age,
           const std::function<Json()>& make) {
    const std::shared_ptr<Entry> entry = find(key);
    const std::lock_guard one_at_a_time(entry->making);
    const bool young = entry->version >= 0 && Steady::now() - entry->made < max_age;
    if (entry->version == version || young) return entry->answer;
    const Steady::time_point begun = Steady::now();
    entry->answer = make();
    entry->made = begun;
    entry->version = version;
    return entry->answer;
  }

 private:
  using Steady = std::chrono::steady_clock;
  static constexpr std::size_t kept = 64;

  struct Entry {
    std::string key;
    std::mutex making;
    std::int64_t version = -1;  ///< none yet
    Steady::time_point made{};
    Json answer;
  };

  /// Moved to the front; what was asked for longest ago is forgotten.
  std::shared_ptr<Entry> find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    for (auto at = entries_.begin(); at != entries_.end(); ++at)
      if ((*at)->key == key) {
        entries_.splice(entries_.begin(), entries_, at);
        return entries_.front();
      }
    entries_.push_front(std::make_shared<Entry>());
    entries_.front()->key = key;
    if (entries_.size() > kept) entries_.pop_back();
    return entries_.front();
  }

  std::mutex mutex_;
  std::list<std::shared_ptr<Entry>> entries_;  ///< newest first
};

}  // namespace talus::service

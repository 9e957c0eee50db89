#pragma once
// The results of expensive requests, kept for requests of the same kind.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "support/json.hpp"

namespace talus::service {

/// The 64 results used last. Concurrent requests for the same key compute it once. Thread-safe.
class ResultCache {
 public:
  /// @param version  of the data that the result depends on, >= 0
  /// @param max_age  a result of an earlier version is returned for this time after its computation
  /// @param compute  called if there is none; its exception goes to the caller, and the next request tries again
  Json get(const std::string& key, std::int64_t version, std::chrono::milliseconds max_age,
           const std::function<Json()>& compute) {
    const std::shared_ptr<Entry> entry = find(key);
    const std::lock_guard one_at_a_time(entry->computing);
    const bool young = entry->version >= 0 && Steady::now() - entry->computed < max_age;
    if (entry->version == version || young) return entry->result;
    const Steady::time_point begun = Steady::now();
    entry->result = compute();
    entry->computed = begun;
    entry->version = version;
    return entry->result;
  }

 private:
  using Steady = std::chrono::steady_clock;
  static constexpr std::size_t capacity = 64;

  struct Entry {
    std::string key;
    std::mutex computing = {};
    std::int64_t version = -1;  ///< -1: no result yet
    Steady::time_point computed = {};
    Json result = {};
  };

  /// The entry of a key, moved to the front; the least recently used one is dropped.
  std::shared_ptr<Entry> find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e->key == key; });
    if (at != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, at);
    } else {
      entries_.push_front(std::make_shared<Entry>());
      entries_.front()->key = key;
      if (entries_.size() > capacity) entries_.pop_back();
    }
    return entries_.front();
  }

  std::mutex mutex_;
  std::list<std::shared_ptr<Entry>> entries_;  ///< last used first
};

}  // namespace talus::service

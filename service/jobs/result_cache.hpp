#pragma once
// The results of expensive requests, kept for requests of the same kind.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "support/json.hpp"

namespace talus::service {

/// At most 64 results; a new one then starts the cache afresh. Concurrent requests for the same key compute it once.
/// Thread-safe.
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
    std::mutex computing = {};
    std::int64_t version = -1;  ///< -1: no result yet
    Steady::time_point computed = {};
    Json result = {};
  };

  std::shared_ptr<Entry> find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    if (entries_.size() >= capacity && !entries_.contains(key)) entries_.clear();
    std::shared_ptr<Entry>& entry = entries_[key];
    if (!entry) entry = std::make_shared<Entry>();
    return entry;
  }

  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Entry>> entries_;
};

}  // namespace talus::service

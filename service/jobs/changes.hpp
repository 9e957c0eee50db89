#pragma once
// Tells who waits that some job has changed.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace talus::service {

class Changes {
 public:
  void announce() {
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
  /// Waits until the count is not `seen` any more, at most so long.
  void wait(std::uint64_t seen, std::chrono::milliseconds most) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [&] { return count_ != seen; });
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t count_ = 0;
};

}  // namespace talus::service

#pragma once
// How much is open, in all and for each subject.

#include <map>
#include <mutex>
#include <string>

namespace talus::service {

/// Thread-safe.
class Places {
 public:
  /// @return false where one more would be too many
  bool take(const std::string& subject, int most, int most_each) {
    const std::lock_guard lock(lock_);
    if (all_ >= most) return false;
    int& own = each_[subject];
    if (own >= most_each) return false;
    ++own;
    ++all_;
    return true;
  }
  void give_back(const std::string& subject) {
    const std::lock_guard lock(lock_);
    if (--each_[subject] == 0) each_.erase(subject);
    --all_;
  }
  int taken() const {
    const std::lock_guard lock(lock_);
    return all_;
  }

 private:
  mutable std::mutex lock_;
  std::map<std::string, int> each_;
  int all_ = 0;
};

}  // namespace talus::service

#include "base/shares.hpp"

#include <algorithm>
#include <utility>

#include "base/refusal.hpp"

namespace talus::service {
namespace {

constexpr int retry_after_s = 5;

}  // namespace

Shares::Shares(std::string what, std::int64_t all, std::int64_t each, int waiting_each)
    : what_(std::move(what)), all_(all), each_(std::min(each, all)), waiting_each_(waiting_each) {}

Shares::Share Shares::take(const Caller& caller, std::int64_t amount, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  amount = std::min(amount, each_);
  Use& mine = uses_[caller.subject];
  const auto fits = [&] { return held_ + amount <= all_ && mine.held + amount <= each_; };
  if (!fits()) {
    bool got = false;
    if (mine.waiting < waiting_each_) {
      ++mine.waiting;
      got = returned_.wait_for(lock, caller.stop, patience, fits);
      --mine.waiting;
    }
    if (!got) {
      forget_if_idle(caller.subject);
      throw Refusal(reason::unavailable, "too many " + what_ + " at once", {}, retry_after_s);
    }
  }
  held_ += amount;
  mine.held += amount;
  return {*this, caller.subject, amount};
}

void Shares::give_back(const std::string& subject, std::int64_t amount) {
  {
    const std::lock_guard lock(mutex_);
    held_ -= amount;
    uses_[subject].held -= amount;
    forget_if_idle(subject);
  }
  returned_.notify_all();
}

void Shares::forget_if_idle(const std::string& subject) {
  const auto use = uses_.find(subject);
  if (use->second.held == 0 && use->second.waiting == 0) uses_.erase(use);
}

}  // namespace talus::service

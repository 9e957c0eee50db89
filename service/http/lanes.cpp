#include "http/lanes.hpp"

#include <algorithm>
#include <system_error>

namespace talus::service {

bool WorkLane::submit(const std::string& subject, std::function<void()> work) {
  const std::lock_guard lock(lock_);
  if (taken_ >= limits_.places) return false;
  if (const auto at = shares_.find(subject); at != shares_.end() && at->second.places >= limits_.places_each)
    return false;
  if (!has_thread_for_one_more()) return false;
  waiting_.push_back({subject, std::move(work)});
  ++shares_[subject].places;
  ++taken_;
  changed_.notify_one();
  return true;
}

/// Called with the lock held. A thread that cannot be had is no fault as long as there is another one.
bool WorkLane::has_thread_for_one_more() {
  if (idle_ > waiting_.size() || threads_.size() >= limits_.threads) return true;
  try {
    threads_.emplace_back([this] { serve(); });
  } catch (const std::system_error&) {
  }
  return !threads_.empty();
}

void WorkLane::serve() {
  std::unique_lock lock(lock_);
  for (;;) {
    ++idle_;
    changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
    --idle_;
    if (waiting_.empty()) return;
    Entry next = take();
    lock.unlock();
    next.work();
    next.work = nullptr;
    lock.lock();
    const auto share = shares_.find(next.subject);
    --share->second.running;
    if (--share->second.places == 0) shares_.erase(share);
    --taken_;
  }
}

/// Called with the lock held: the oldest of the subject with the least under way.
WorkLane::Entry WorkLane::take() {
  const auto running = [&](const Entry& entry) { return shares_.at(entry.subject).running; };
  const auto next = std::min_element(waiting_.begin(), waiting_.end(),
                                     [&](const Entry& a, const Entry& b) { return running(a) < running(b); });
  Entry entry = std::move(*next);
  waiting_.erase(next);
  ++shares_.at(entry.subject).running;
  return entry;
}

void WorkLane::join() {
  {
    const std::lock_guard lock(lock_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace talus::service

#include "http/lanes.hpp"

#include <algorithm>
#include <new>
#include <system_error>

namespace talus::service {

WorkLane::WorkLane(LaneLimits limits) : limits_(limits) {
  threads_.emplace_back([this] { serve(); });
}

bool WorkLane::submit(const std::string& subject, std::function<void()> work) {
  const std::lock_guard lock(lock_);
  if (taken_ >= limits_.places) return false;
  if (const auto at = shares_.find(subject); at != shares_.end() && at->second.places >= limits_.places_each)
    return false;
  waiting_.push_back({subject, std::move(work)});
  ++shares_[subject].places;
  ++taken_;
  add_thread_if_needed();
  changed_.notify_one();
  return true;
}

/// Called with the lock held. A thread that the system does not give is no fault: there is another one.
void WorkLane::add_thread_if_needed() {
  if (idle_ >= waiting_.size() || threads_.size() >= limits_.threads) return;
  try {
    threads_.emplace_back([this] { serve(); });
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
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

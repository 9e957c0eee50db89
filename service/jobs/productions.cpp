#include "jobs/productions.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/refusal.hpp"

namespace talus::service {
namespace {

constexpr std::chrono::seconds late_client{60};  ///< how long a thing is made on for a client that asks again
constexpr int ask_again_s = 5;

}  // namespace

Productions::Productions(const Limits& limits)
    : limits_(limits),
      waiting_("requests that wait for something to be made", limits.waiting, limits.waiting_of_one, 0) {}

Productions::~Productions() {
  stop();
  for (std::thread& thread : threads_) thread.join();
}

void Productions::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
  done_.notify_all();
}

std::string Productions::get(const std::string& name, const Caller& caller, std::chrono::milliseconds patience,
                             Make make) {
  const Shares::Share place = waiting_.take(caller, 1, std::chrono::milliseconds(0));
  std::unique_lock lock(mutex_);
  const std::shared_ptr<Thing> thing = find_or_queue(name, caller, std::move(make));
  ++thing->waiting;
  done_.wait_for(lock, caller.stop, patience, [&] { return thing->done || stopping_; });
  --thing->waiting;
  if (thing->done && !thing->error) return thing->made;
  if (stopping_) throw Refusal(reason::unavailable, "talusd is stopping");
  if (thing->error) std::rethrow_exception(thing->error);
  if (!caller.stop.stop_requested()) thing->kept_until = Steady::now() + late_client;
  throw Refusal(reason::unavailable, "not ready yet; it is being made: ask again", {}, ask_again_s);
}

std::shared_ptr<Productions::Thing> Productions::find_or_queue(const std::string& name, const Caller& caller,
                                                               Make make) {
  if (const auto found = things_.find(name); found != things_.end()) return found->second;
  std::erase_if(queue_, [this](const std::shared_ptr<Thing>& thing) {
    if (!is_abandoned(thing)) return false;
    forget(thing);
    return true;
  });
  if (queue_.size() >= idle_ && threads_.size() < static_cast<std::size_t>(limits_.at_a_time)) start_thread();
  const auto thing = std::make_shared<Thing>(Thing{.name = name, .subject = caller.subject, .make = std::move(make)});
  things_.emplace(name, thing);
  queue_.push_back(thing);
  work_.notify_one();
  return thing;
}

void Productions::start_thread() {
  try {
    threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    if (threads_.empty()) throw Refusal(reason::unavailable, "no thread can be started", {}, ask_again_s);
  }
}

void Productions::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    ++idle_;
    work_.wait(lock, [&] { return stopping_ || !queue_.empty(); });
    --idle_;
    if (stopping_) return;
    const auto at = next();
    const std::shared_ptr<Thing> thing = *at;
    queue_.erase(at);
    if (is_abandoned(thing))
      forget(thing);
    else
      carry_out(thing, lock);
  }
}

Productions::Things::iterator Productions::next() {
  return std::min_element(queue_.begin(), queue_.end(), [this](const auto& a, const auto& b) {
    return subjects_[a->subject] < subjects_[b->subject];
  });
}

void Productions::carry_out(const std::shared_ptr<Thing>& thing, std::unique_lock<std::mutex>& lock) {
  Subject& subject = subjects_[thing->subject];
  ++subject.under_way;
  subject.served = served_++;
  lock.unlock();
  std::string made;
  std::exception_ptr error;
  try {
    made = thing->make([&] {
      const std::lock_guard again(mutex_);
      if (!is_abandoned(thing)) return false;
      forget(thing);  // who asks from now on gets a new one
      return true;
    });
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  thing->made = std::move(made);
  thing->error = error;
  thing->done = true;
  thing->make = {};
  forget(thing);
  --subject.under_way;
  done_.notify_all();
}

bool Productions::is_abandoned(const std::shared_ptr<Thing>& thing) {
  return stopping_ || (thing->waiting == 0 && Steady::now() >= thing->kept_until);
}

void Productions::forget(const std::shared_ptr<Thing>& thing) {
  const auto found = things_.find(thing->name);
  if (found != things_.end() && found->second == thing) things_.erase(found);
}

}  // namespace talus::service

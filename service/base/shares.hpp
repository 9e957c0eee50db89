#pragma once
// What requests share: at most so much in all, and so much of one subject.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

namespace talus::service {

/// For whom something is done.
struct Caller {
  std::string subject;
  std::stop_token stop = {};  ///< stop is requested when nobody waits for it any more
};

/// A number of units, of which requests hold some: places, bytes. Thread-safe.
class Shares {
 public:
  /// @param what  that has a share, in the message of a refusal: "requests that check a case"
  /// @param all   units in all
  /// @param each  units of one subject
  /// @param waiting_each  requests of one subject that may wait for a share
  Shares(std::string what, std::int64_t all, std::int64_t each, int waiting_each);

  /// Returns its units when it goes.
  class Share {
   public:
    Share(Share&& other) noexcept
        : owner_(std::exchange(other.owner_, nullptr)), subject_(std::move(other.subject_)), amount_(other.amount_) {}
    Share& operator=(Share&&) = delete;
    ~Share() {
      if (owner_) owner_->give_back(subject_, amount_);
    }

   private:
    friend class Shares;
    Share(Shares& owner, std::string subject, std::int64_t amount)
        : owner_(&owner), subject_(std::move(subject)), amount_(amount) {}
    Shares* owner_;
    std::string subject_;
    std::int64_t amount_;
  };

  /// Waits for `amount` units, or as many as one subject may have.
  /// @throws Refusal unavailable, when `patience` is over, the caller stops, or too many of the subject wait already
  Share take(const Caller& caller, std::int64_t amount, std::chrono::milliseconds patience);

 private:
  struct Use {
    std::int64_t held = 0;
    int waiting = 0;
  };
  void give_back(const std::string& subject, std::int64_t amount);
  void forget_if_idle(const std::string& subject);

  std::string what_;
  std::int64_t all_, each_;
  int waiting_each_;
  std::mutex mutex_;
  std::condition_variable_any returned_;
  std::int64_t held_ = 0;
  std::map<std::string, Use> uses_;  ///< by subject
};

}  // namespace talus::service

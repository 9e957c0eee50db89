#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "base/refusal.hpp"
#include "jobs/productions.hpp"

namespace talus::service {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds at_once{0};
constexpr std::chrono::hours long_time{1};

/// Waits until something holds that another thread brings about.
template <class Condition>
void wait_until(const Condition& holds) {
  while (!holds()) std::this_thread::sleep_for(milliseconds(1));
}

struct ProductionsTest : testing::Test {
  std::atomic<int> made{0};
  std::atomic<bool> open{false};  ///< whether what is being made may end
  std::atomic<bool> ended{false};

  /// A thing that is made when the gate opens, or not at all where nobody waits for it any more.
  std::string behind_gate(const Productions::Abandoned& abandoned) {
    wait_until([&] { return open || abandoned(); });
    ended = true;
    if (!open) throw std::runtime_error("abandoned");
    return std::to_string(++made);
  }
  Productions::Make gated() {
    return [this](const auto& abandoned) { return behind_gate(abandoned); };
  }
  static std::string why(Productions& productions, const std::string& name, const std::string& subject = "a") {
    try {
      return productions.get(name, {subject}, at_once, [](const auto&) { return std::string("made"); });
    } catch (const Refusal& e) {
      EXPECT_EQ(e.reason, reason::unavailable);
      return e.what();
    }
  }
  static bool is_too_many(const std::string& text) { return text.starts_with("too many requests that wait"); }

  /// Waits for the thing "a" for subject a, once there is a place: why() takes one for a moment.
  std::string wait_for_a(Productions& productions) {
    for (;;) {
      try {
        return productions.get("a", {"a"}, long_time, gated());
      } catch (const Refusal& e) {
        if (!is_too_many(e.what())) throw;
      }
    }
  }
};

TEST_F(ProductionsTest, OneThingIsMadeOnceForAllWhoWait) {
  Productions productions({.at_a_time = 2, .waiting = 16, .waiting_of_one = 16});
  std::vector<std::thread> waiting;
  for (int i = 0; i < 16; ++i) waiting.emplace_back([&] { EXPECT_EQ(wait_for_a(productions), "1"); });
  wait_until([&] { return is_too_many(why(productions, "probe")); });
  open = true;
  for (std::thread& thread : waiting) thread.join();
  EXPECT_EQ(made, 1);
  EXPECT_EQ(productions.get("a", {"a"}, long_time, gated()), "2");
}

TEST_F(ProductionsTest, OneSubjectCannotTakeAllPlaces) {
  Productions productions({.at_a_time = 1, .waiting = 3, .waiting_of_one = 2});
  std::vector<std::thread> waiting;
  for (int i = 0; i < 2; ++i) waiting.emplace_back([&] { wait_for_a(productions); });
  wait_until([&] { return is_too_many(why(productions, "probe")); });
  EXPECT_EQ(why(productions, "b", "b"), "not ready yet; it is being made: ask again");
  open = true;
  for (std::thread& thread : waiting) thread.join();
}

TEST_F(ProductionsTest, WhoIsImpatientFindsItLater) {
  Productions productions({.at_a_time = 1, .waiting = 1, .waiting_of_one = 1});
  for (const char* subject : {"a", "b"}) EXPECT_THROW(productions.get("a", {subject}, at_once, gated()), Refusal);
  std::thread waiting([&] { EXPECT_EQ(wait_for_a(productions), "1"); });
  wait_until([&] { return is_too_many(why(productions, "probe")); });
  open = true;
  waiting.join();
  EXPECT_EQ(made, 1);
}

TEST_F(ProductionsTest, WhatNobodyWaitsForAnyMoreIsNotBegun) {
  Productions productions({.at_a_time = 1});
  EXPECT_THROW(productions.get("a", {"a"}, at_once, gated()), Refusal);
  std::stop_source left;
  left.request_stop();
  EXPECT_THROW(productions.get("b", {"a", left.get_token()}, long_time, gated()), Refusal);
  open = true;
  EXPECT_EQ(productions.get("c", {"a"}, long_time, gated()), "2");
}

TEST_F(ProductionsTest, WorkEndsWhenItsOnlyClientLeaves) {
  Productions productions({});
  std::stop_source leaving;
  std::atomic<bool> begun{false};
  std::thread waiting([&] {
    EXPECT_THROW(productions.get("a", {"a", leaving.get_token()}, long_time,
                                 [&](const Productions::Abandoned& abandoned) {
                                   begun = true;
                                   return behind_gate(abandoned);
                                 }),
                 Refusal);
  });
  wait_until([&] { return begun.load(); });
  EXPECT_FALSE(ended);
  leaving.request_stop();
  waiting.join();
  wait_until([&] { return ended.load(); });
}

TEST_F(ProductionsTest, AFailureGoesToWhoWaitsAndTheNextTriesAgain) {
  Productions productions({});
  EXPECT_THROW(
      productions.get("a", {"a"}, long_time, [](const auto&) -> std::string { throw std::runtime_error("x"); }),
      std::runtime_error);
  EXPECT_EQ(productions.get("a", {"a"}, long_time, [](const auto&) { return std::string("b"); }), "b");
}

TEST_F(ProductionsTest, SubjectsTakeTurns) {
  Productions productions({.at_a_time = 1});
  std::mutex mutex;
  std::string order;
  const auto ask = [&](const std::string& name, const std::string& subject) {
    EXPECT_THROW(productions.get(name, {subject}, at_once,
                                 [&, name](const Productions::Abandoned& abandoned) {
                                   behind_gate(abandoned);
                                   const std::lock_guard lock(mutex);
                                   return order += name + " ";
                                 }),
                 Refusal);
  };
  for (const char* name : {"a1", "a2", "a3"}) ask(name, "a");
  ask("b1", "b");
  open = true;
  wait_until([&] { return made == 4; });
  EXPECT_EQ(productions.get("end", {"a"}, long_time, [&](const auto&) { return order; }), "a1 b1 a2 a3 ");
}

TEST_F(ProductionsTest, StoppingEndsEverything) {
  Productions productions({});
  std::thread waiting([&] { EXPECT_THROW(productions.get("a", {"a"}, long_time, gated()), Refusal); });
  productions.stop();
  waiting.join();
  EXPECT_EQ(why(productions, "a"), "talusd is stopping");
}

}  // namespace
}  // namespace talus::service

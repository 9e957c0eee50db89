#include <gtest/gtest.h>

#include <functional>

#include "run/thread_choice.hpp"

namespace talus {
namespace {

/// Steps for some seconds of wall clock, each taking step(threads). Returns the share of the time with `threads`.
double share_with(int threads, ThreadChoice& choice, double seconds, const std::function<double(int)>& step) {
  double with = 0.0, all = 0.0;
  while (all < seconds) {
    const int used = choice.count();
    const double taken = step(used);
    all += taken;
    if (used == threads) with += taken;
    choice.record(taken);
  }
  return with / all;
}

double idle_machine(int threads) { return 1e-3 / threads; }
double busy_machine(int threads) { return threads == 1 ? 2e-3 : 1e-2; }

TEST(ThreadChoice, SmallRunsTakeOneThread) {
  EXPECT_EQ(ThreadChoice(900, 64).count(), 1);
  EXPECT_EQ(ThreadChoice(0, 64).count(), 1);
  EXPECT_EQ(ThreadChoice(4 * ThreadChoice::particles_per_thread, 64).count(), 4);
  EXPECT_EQ(ThreadChoice(1'000'000, 64).count(), 64);
  EXPECT_EQ(ThreadChoice(1'000'000, 1).count(), 1);
}

TEST(ThreadChoice, TheUsersNumberStays) {
  ThreadChoice choice(900, 2, 3);
  EXPECT_EQ(share_with(3, choice, 30.0, busy_machine), 1.0);
}

TEST(ThreadChoice, KeepsItsThreadsOnAnIdleMachine) {
  ThreadChoice choice(1'000'000, 8);
  EXPECT_GT(share_with(8, choice, 30.0, idle_machine), 0.98);
  EXPECT_EQ(choice.most_used(), 8);
}

TEST(ThreadChoice, GivesThreadsUpOnABusyMachineAndTakesThemBack) {
  ThreadChoice choice(1'000'000, 2);
  EXPECT_GT(share_with(1, choice, 30.0, busy_machine), 0.8);
  share_with(1, choice, 15.0, idle_machine);
  EXPECT_GT(share_with(2, choice, 30.0, idle_machine), 0.95);
}

TEST(ThreadChoice, FindsTheBestNumberBetweenOneAndAll) {
  ThreadChoice choice(1'000'000, 16);
  const auto best_at_four = [](int threads) { return threads <= 4 ? 1e-2 / threads : 1e-3 * threads; };
  share_with(4, choice, 20.0, best_at_four);
  EXPECT_GT(share_with(4, choice, 30.0, best_at_four), 0.9);
}

}  // namespace
}  // namespace talus

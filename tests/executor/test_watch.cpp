// What the watch over a process ends, and what it leaves alone. Limits are seconds; no test depends on how long it
// takes.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "executor/watch.hpp"
#include "files.hpp"

namespace talus::executor {
namespace {

struct WatchedProcess : testing::Test {
  test::TemporaryDirectory directory;

  /// Runs a shell script under the watch until it ends.
  std::pair<ProcessEnd, Watch> end_of(const std::string& script, const Limits& limits) const {
    Process process({.arguments = {"/bin/sh", "-c", script}}, directory / "out", directory / "out");
    Watch watch(limits);
    std::optional<ProcessEnd> end;
    for (; !end; end = process.poll()) {
      watch.look(process);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return {*end, watch};
  }
};

TEST_F(WatchedProcess, StoppedIsContinuedAndAskedToEnd) {
  const auto [end, watch] = end_of("trap 'exit 6' TERM; kill -STOP $$; exit 0", {.stall_seconds = 1});
  EXPECT_EQ(end.exit_code, 6);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(watch.timed_out());
  EXPECT_EQ(watch.why(), "hung: no CPU time used for 1 s");
}

TEST_F(WatchedProcess, DeafToTheRequestIsKilled) {
  const auto [end, watch] = end_of("trap '' TERM; sleep 1000", {.stall_seconds = 1});
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_FALSE(watch.timed_out());
  EXPECT_NE(watch.why(), "");
}

TEST_F(WatchedProcess, AtWorkIsLeftAlone) {
  const auto [end, watch] = end_of(
      "until=$(($(date +%s) + 3)); while [ $(date +%s) -lt $until ]; do i=0; while [ $i -lt 2000 ]; do i=$((i + 1)); "
      "done; done; exit 3",
      {.stall_seconds = 1});
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(watch.why(), "");
}

TEST_F(WatchedProcess, IdleWithoutALimitIsLeftAlone) {
  const auto [end, watch] = end_of("sleep 2; exit 3", {});
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(watch.why(), "");
}

TEST_F(WatchedProcess, TooLongIsKilled) {
  const auto [end, watch] = end_of("while :; do :; done", {.wall_seconds = 1, .stall_seconds = 1});
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_TRUE(watch.timed_out());
  EXPECT_EQ(watch.why(), "");
}

TEST(CpuSeconds, GrowForAProcessAtWorkAndAreUnknownForNone) {
  const std::optional<double> before = cpu_seconds_of(::getpid());
  ASSERT_TRUE(before);
  while (*cpu_seconds_of(::getpid()) < *before + 0.05) {
  }
  EXPECT_FALSE(cpu_seconds_of(-1));
}

}  // namespace
}  // namespace talus::executor

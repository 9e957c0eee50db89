// A child process: its limits, and that its whole group ends.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "executor/process.hpp"
#include "files.hpp"

namespace talus::executor {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct ProcessGroup : testing::Test {
  test::TemporaryDirectory directory;

  Process shell(const std::string& script, const Limits& limits = {}) const {
    return Process({.arguments = {"/bin/sh", "-c", script}, .limits = limits}, directory.path() / "out",
                   directory.path() / "err");
  }
  std::string said() const { return test::content(directory.path() / "out"); }

  template <class Condition>
  static bool becomes_true(Condition condition) {
    const auto deadline = Steady::now() + seconds(10);
    while (!condition()) {
      if (Steady::now() > deadline) return false;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
  }
  static std::optional<ProcessEnd> end_of(Process& child) {
    becomes_true([&] { return child.poll().has_value(); });
    return child.poll();
  }
  /// Whether a process is there and no zombie.
  static bool alive(const std::string& pid) {
    const std::string stat = test::content("/proc/" + pid + "/stat");
    return !stat.empty() && stat.find(") Z ") == std::string::npos;
  }
};

rlim_t limit_of(const Process& child, __rlimit_resource what) {
  rlimit found{};
  EXPECT_EQ(::prlimit(child.pid(), what, nullptr, &found), 0);
  EXPECT_EQ(found.rlim_cur, found.rlim_max);
  return found.rlim_cur;
}

TEST_F(ProcessGroup, HasTheLimitsThatItWasGiven) {
  const Process child =
      shell("sleep 100", {.memory_bytes = 1 << 30, .cpu_seconds = 77, .file_bytes = 1 << 20, .core_dumps = false});
  EXPECT_EQ(limit_of(child, RLIMIT_AS), rlim_t{1} << 30);
  EXPECT_EQ(limit_of(child, RLIMIT_CPU), rlim_t{77});
  EXPECT_EQ(limit_of(child, RLIMIT_FSIZE), rlim_t{1} << 20);
  EXPECT_EQ(limit_of(child, RLIMIT_CORE), rlim_t{0});
}

TEST_F(ProcessGroup, AZeroIsNoLimit) {
  const Process child = shell("sleep 100");
  rlimit ours{};
  ::getrlimit(RLIMIT_FSIZE, &ours);
  EXPECT_EQ(limit_of(child, RLIMIT_FSIZE), ours.rlim_cur);
}

TEST_F(ProcessGroup, ASignalReachesItsWholeGroup) {
  Process child = shell("trap 'exit 7' TERM; echo ready; sleep 100; exit 1");  // the trap waits for sleep to end
  ASSERT_TRUE(becomes_true([&] { return said() == "ready\n"; }));
  std::this_thread::sleep_for(milliseconds(50));  // for sleep to start
  child.signal(SIGTERM);
  const std::optional<ProcessEnd> end = end_of(child);
  ASSERT_TRUE(end) << "sleep did not hear the signal";
  EXPECT_EQ(end->exit_code, 7);
}

TEST_F(ProcessGroup, WhatItLeavesBehindIsKilled) {
  Process child = shell("sleep 100 & echo $!");
  ASSERT_EQ(end_of(child)->exit_code, 0);
  const std::string orphan = said().substr(0, said().find('\n'));
  EXPECT_TRUE(becomes_true([&] { return !alive(orphan); }));
}

TEST_F(ProcessGroup, IsKilledWhenItsOwnerGoes) {
  std::string pids;
  {
    const Process child = shell("sleep 100 & echo $! $$; wait");
    ASSERT_TRUE(becomes_true([&] { return said().ends_with('\n'); }));
    pids = said().substr(0, said().find('\n'));
  }
  const std::size_t space = pids.find(' ');
  EXPECT_TRUE(becomes_true([&] { return !alive(pids.substr(0, space)) && !alive(pids.substr(space + 1)); }));
}

}  // namespace
}  // namespace talus::executor

// A child process: limits, environment, and that its whole group ends.

#include "process/child.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdlib>
#include <thread>

#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus::service {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct ChildTest : testing::Test {
  test::TemporaryDirectory directory;

  Child shell(const std::string& script, const Limits& limits = {}) const {
    return Child({.arguments = {"/bin/sh", "-c", script}, .threads = 3, .limits = limits}, directory / "out",
                 directory / "err");
  }
  std::string said() const { return *read_file(directory / "out", 1 << 16); }

  template <class Condition>
  static bool becomes_true(Condition condition) {
    const auto deadline = Steady::now() + seconds(10);
    while (!condition()) {
      if (Steady::now() > deadline) return false;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
  }
  static std::optional<End> end_of(Child& child) {
    becomes_true([&] { return child.poll().has_value(); });
    return child.poll();
  }
  /// Whether a process is there and no zombie.
  static bool alive(const std::string& pid) {
    const auto stat = read_file("/proc/" + pid + "/stat", 4096);
    return stat && stat->find(") Z ") == std::string::npos;
  }
};

rlim_t limit_of(const Child& child, __rlimit_resource what) {
  rlimit found{};
  EXPECT_EQ(::prlimit(child.pid(), what, nullptr, &found), 0);
  EXPECT_EQ(found.rlim_cur, found.rlim_max);
  return found.rlim_cur;
}

TEST_F(ChildTest, HasTheLimitsThatItWasGiven) {
  const Child child = shell("sleep 100", {.memory_bytes = 1 << 30, .cpu_seconds = 77, .file_bytes = 1 << 20});
  EXPECT_EQ(limit_of(child, RLIMIT_AS), rlim_t{1} << 30);
  EXPECT_EQ(limit_of(child, RLIMIT_CPU), rlim_t{77});
  EXPECT_EQ(limit_of(child, RLIMIT_FSIZE), rlim_t{1} << 20);
  EXPECT_EQ(limit_of(child, RLIMIT_CORE), rlim_t{0});
}

TEST_F(ChildTest, AZeroIsNoLimit) {
  const Child child = shell("sleep 100");
  rlimit ours{};
  ::getrlimit(RLIMIT_FSIZE, &ours);
  EXPECT_EQ(limit_of(child, RLIMIT_FSIZE), ours.rlim_cur);
}

TEST_F(ChildTest, HasAnEnvironmentOfItsOwn) {
  ::setenv("SECRET_OF_THE_SERVER", "s3cr3t", 1);
  Child child = shell("env");
  EXPECT_EQ(end_of(child)->exit_code, 0);
  EXPECT_EQ(said().find("s3cr3t"), std::string::npos);
  EXPECT_NE(said().find("OMP_NUM_THREADS=3"), std::string::npos);
}

TEST_F(ChildTest, ASignalReachesItsWholeGroup) {
  Child child = shell("trap 'exit 7' TERM; echo ready; sleep 100; exit 1");  // the trap waits for sleep to end
  ASSERT_TRUE(becomes_true([&] { return said() == "ready\n"; }));
  std::this_thread::sleep_for(milliseconds(50));  // for sleep to start
  child.signal(SIGTERM);
  const std::optional<End> end = end_of(child);
  ASSERT_TRUE(end) << "sleep did not hear the signal";
  EXPECT_EQ(end->exit_code, 7);
}

TEST_F(ChildTest, WhatItLeavesBehindIsKilled) {
  Child child = shell("sleep 100 & echo $!");
  ASSERT_EQ(end_of(child)->exit_code, 0);
  const std::string orphan = said().substr(0, said().find('\n'));
  EXPECT_TRUE(becomes_true([&] { return !alive(orphan); }));
}

TEST_F(ChildTest, IsKilledWhenItsOwnerGoes) {
  std::string pids;
  {
    const Child child = shell("sleep 100 & echo $! $$; wait");
    ASSERT_TRUE(becomes_true([&] { return said().ends_with('\n'); }));
    pids = said().substr(0, said().find('\n'));
  }
  const std::size_t space = pids.find(' ');
  EXPECT_TRUE(becomes_true([&] { return !alive(pids.substr(0, space)) && !alive(pids.substr(space + 1)); }));
}

TEST_F(ChildTest, AShortCommandIsKilledAfterItsLimit) {
  const auto begin = Steady::now();
  const Outcome outcome =
      run_to_end({.arguments = {"/bin/sh", "-c", "echo begun; sleep 100"}}, directory.path(), milliseconds(200));
  EXPECT_TRUE(outcome.timed_out);
  EXPECT_EQ(outcome.end.signal, SIGKILL);
  EXPECT_EQ(outcome.out, "begun\n");
  EXPECT_LT(Steady::now() - begin, seconds(10));
}

TEST_F(ChildTest, AMissingProgramIsAnError) {
  EXPECT_THROW(Child({.arguments = {"/none"}}, directory / "out", directory / "err"), FileError);
}

}  // namespace
}  // namespace talus::service

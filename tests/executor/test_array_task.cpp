// The node's side, without Slurm.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "executor/slurm_batch.hpp"
#include "files.hpp"

using namespace talus::executor;
using talus::test::content;
using talus::test::TemporaryDirectory;
using talus::test::write;
namespace fs = std::filesystem;

namespace {

/// A batch of one array task, number 3, with runs that are shell scripts.
struct Fixture {
  TemporaryDirectory directory;
  BatchDirectory batch{directory / "batch"};
  std::vector<talus::executor::Run> runs;

  void add(const std::string& script, std::uint64_t wall_seconds = 0) {
    const std::string name = std::to_string(runs.size());
    fs::create_directories(directory / name);
    runs.push_back({.name = name,
                    .group = "g",
                    .command = {.arguments = {"/bin/sh", "-c", script, "sh"}},
                    .directory = directory / name,
                    .log = directory / (name + ".log")});
    runs.back().command.limits.wall_seconds = wall_seconds;
  }
  void write_batch() const { batch.write({{}, {}, {}, runs}); }
  /// In a process of its own, as on a node. @return its id
  pid_t start() const {
    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    ::setenv("SLURM_ARRAY_TASK_ID", "3", 1);
    ::_exit(execute_array_task(batch));
  }
  static int wait(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  void until_log(std::size_t run) const {
    while (content(runs[run].log).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  /// Asks the task to stop while its first run is under way, and waits for its end.
  void start_and_stop() {
    write_batch();
    const pid_t pid = start();
    until_log(0);
    ::kill(pid, SIGTERM);
    EXPECT_EQ(wait(pid), 0);
  }
};

}  // namespace

TEST(ArrayTask, EndsARunThatHangs) {
  Fixture f;
  f.add("trap 'exit 6' TERM; kill -STOP $$; exit 0");
  f.runs.back().command.limits.stall_seconds = 1;
  f.write_batch();
  EXPECT_EQ(f.wait(f.start()), 0);
  EXPECT_EQ(f.batch.status({3, 0}).end.exit_code, 6);
  EXPECT_EQ(f.batch.status({3, 0}).why, "hung: no CPU time used for 1 s");
}

TEST(ArrayTask, TellsOfEveryRunHowItEnded) {
  Fixture f;
  f.add("echo $1");
  f.add("exit 4");
  f.add("kill -9 $$");
  f.add("sleep 100", 1);
  f.write_batch();
  write(f.directory / "1" / "checkpoint.h5", "state");
  EXPECT_EQ(f.wait(f.start()), 0);
  EXPECT_EQ(f.batch.status({3, 0}).end.exit_code, 0);
  EXPECT_FALSE(f.batch.status({3, 0}).resumed);
  EXPECT_EQ(content(f.runs[0].log), "--resume\n");
  EXPECT_EQ(f.batch.status({3, 1}).end.exit_code, 4);
  EXPECT_TRUE(f.batch.status({3, 1}).resumed);
  EXPECT_EQ(f.batch.status({3, 2}).end.signal, SIGKILL);
  EXPECT_FALSE(f.batch.status({3, 2}).timed_out);
  EXPECT_TRUE(f.batch.status({3, 3}).timed_out);
  EXPECT_GT(f.batch.status({3, 3}).seconds, 1.0);
}

TEST(ArrayTask, StartedAgainItSkipsWhatHasEnded) {
  Fixture f;
  f.add("echo again");
  f.add("echo first");
  f.write_batch();
  f.batch.write_status({3, 0}, {.end = {.exit_code = 4}});
  EXPECT_EQ(f.wait(f.start()), 0);
  EXPECT_FALSE(fs::exists(f.runs[0].log));
  EXPECT_EQ(f.batch.status({3, 0}).end.exit_code, 4);
  EXPECT_EQ(content(f.runs[1].log), "first\n");
}

TEST(ArrayTask, PassesTheSignalOnAndLeavesTheRestToAnother) {
  Fixture f;
  f.add("trap 'echo checkpoint; exit 6' TERM; echo ready; sleep 100 & wait");
  f.add("echo never");
  f.start_and_stop();
  EXPECT_EQ(content(f.runs[0].log), "ready\ncheckpoint\n");
  EXPECT_TRUE(f.batch.statuses().empty());
  EXPECT_FALSE(fs::exists(f.runs[1].log));
}

TEST(ArrayTask, ARunThatEndsAllTheSameWhenAskedToStopCounts) {
  Fixture f;
  f.add("trap 'exit 0' TERM; echo ready; sleep 100 & wait");
  f.add("echo never");
  f.start_and_stop();
  EXPECT_EQ(f.batch.statuses(), (std::vector<RunPlace>{{3, 0}}));
}

TEST(ArrayTask, EndsWhatIsNotWantedAnyMore) {
  Fixture f;
  f.add("echo ready; sleep 100");
  f.add("echo never");
  f.write_batch();
  const pid_t pid = f.start();
  f.until_log(0);
  f.batch.want_killed({3, 0});
  f.batch.want_killed({3, 1});
  EXPECT_EQ(f.wait(pid), 0);
  EXPECT_EQ(f.batch.status({3, 0}).end.signal, SIGKILL);
  EXPECT_EQ(f.batch.status({3, 1}).end.signal, SIGKILL);
  EXPECT_FALSE(fs::exists(f.runs[1].log));
}

TEST(ArrayTask, WhatCannotBeStartedIsTold) {
  Fixture f;
  f.add("true");
  f.runs[0].log = f.directory / "nowhere" / "log";
  f.write_batch();
  EXPECT_EQ(f.wait(f.start()), 0);
  EXPECT_EQ(f.batch.status({3, 0}).end.exit_code, 5);
  EXPECT_NE(f.batch.status({3, 0}).why.find("nowhere"), std::string::npos);
}

TEST(ArrayTask, BeginsNothingWhereTheBatchIsGone) {
  Fixture f;
  f.add("echo never");
  EXPECT_EQ(f.wait(f.start()), 0);
  EXPECT_FALSE(fs::exists(f.runs[0].log));
  ::unsetenv("SLURM_ARRAY_TASK_ID");
  EXPECT_EQ(execute_array_task(f.batch), 2);
  ::setenv("SLURM_ARRAY_TASK_ID", "1x", 1);
  EXPECT_EQ(execute_array_task(f.batch), 2);
}

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "executor/executor.hpp"
#include "files.hpp"

using namespace talus::executor;
using talus::test::content;
using talus::test::TemporaryDirectory;
using talus::test::write;

namespace {

Run shell(const TemporaryDirectory& directory, const std::string& name, const std::string& script) {
  std::filesystem::create_directories(directory / name);
  return {.name = name,
          .group = "g",
          .command = {.arguments = {"/bin/sh", "-c", script, "sh"}},
          .directory = directory / name,
          .log = directory / (name + ".log")};
}

Ended next(Executor& executor) {
  while (true) {
    const std::vector<Ended> all = executor.poll();
    if (!all.empty()) return all.front();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace

TEST(LocalExecutor, HasAsManyPlacesAsItWasGiven) {
  const TemporaryDirectory directory;
  const auto local = make_local_executor(2);
  Executor& executor = *local;
  EXPECT_TRUE(executor.has_room());
  const RunId first = executor.start(shell(directory, "a", "exit 3"));
  const RunId second = executor.start(shell(directory, "b", "sleep 100"));
  EXPECT_NE(first, second);
  EXPECT_FALSE(executor.has_room());
  const Ended ended = next(executor);
  EXPECT_EQ(ended.id, first);
  EXPECT_EQ(ended.end.exit_code, 3);
  EXPECT_FALSE(ended.preempted);
  EXPECT_TRUE(executor.has_room());
  executor.kill(second);
  EXPECT_EQ(next(executor).end.signal, SIGKILL);
}

TEST(LocalExecutor, ResumesWhereThereIsACheckpointAndStartsAfreshWhereThereIsNone) {
  const TemporaryDirectory directory;
  const auto local = make_local_executor(1);
  Executor& executor = *local;
  const talus::executor::Run run = shell(directory, "a", "echo $# $1");
  write(run.directory / "left", "over");
  executor.start(run);
  EXPECT_FALSE(next(executor).resumed);
  EXPECT_EQ(content(run.log), "0\n");
  EXPECT_FALSE(std::filesystem::exists(run.directory / "left"));
  std::filesystem::create_directories(run.directory);
  write(run.directory / "checkpoint.h5", "state");
  executor.start(run);
  EXPECT_TRUE(next(executor).resumed);
  EXPECT_EQ(content(run.log), "1 --resume\n");
}

TEST(LocalExecutor, EndsWhatTakesTooLongAndAsksAllToStop) {
  const TemporaryDirectory directory;
  const auto local = make_local_executor(2);
  Executor& executor = *local;
  talus::executor::Run slow = shell(directory, "a", "sleep 100");
  slow.command.limits.wall_seconds = 1;
  executor.start(slow);
  const Ended late = next(executor);
  EXPECT_TRUE(late.timed_out);
  EXPECT_EQ(late.end.signal, SIGKILL);
  const talus::executor::Run polite = shell(directory, "b", "trap 'exit 6' TERM; echo ready; sleep 100 & wait");
  executor.start(polite);
  while (content(polite.log).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  executor.stop_all();
  EXPECT_EQ(next(executor).end.exit_code, 6);
}

#include <signal.h>

#include <chrono>
#include <thread>

#include "executor/process.hpp"
#include "files.hpp"

using namespace talus::executor;
using talus::test::content;
using talus::test::TemporaryDirectory;
using talus::test::write;

namespace {

ProcessEnd wait_for(Process& process) {
  while (true) {
    if (const auto end = process.poll()) return *end;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace

TEST(Process, TellsHowItEndedAndKeepsWhatItSaid) {
  const TemporaryDirectory directory;
  const auto log = directory.path() / "log";
  Process process({.arguments = {"/bin/sh", "-c", "echo out; echo err >&2; exit 7"}}, log, log);
  const ProcessEnd end = wait_for(process);
  EXPECT_EQ(end.exit_code, 7);
  EXPECT_EQ(end.signal, 0);
  EXPECT_EQ(content(log), "out\nerr\n");
  EXPECT_EQ(process.poll()->exit_code, 7);  // asking again is harmless
}

TEST(Process, SignalsReachItAndItsChildren) {
  const TemporaryDirectory directory;
  const auto log = directory.path() / "log";
  Process process({.arguments = {"/bin/sh", "-c", "sleep 100 & echo ready; wait"}}, log, log);
  while (content(directory.path() / "log").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  process.signal(SIGTERM);
  EXPECT_EQ(wait_for(process).signal, SIGTERM);
}

TEST(Process, IsKilledWithItsOwner) {
  const TemporaryDirectory directory;
  pid_t pid = 0;
  {
    const auto log = directory.path() / "log";
    const Process process({.arguments = {"/bin/sleep", "100"}}, log, log);
    pid = process.pid();
    EXPECT_EQ(::kill(pid, 0), 0);
  }
  EXPECT_NE(::kill(pid, 0), 0);
}

TEST(Process, WhatCannotBeStartedIsNamed) {
  const TemporaryDirectory directory;
  const auto log = directory.path() / "log";
  try {
    Process({.arguments = {"/no/such/program"}}, log, log);
    FAIL();
  } catch (const talus::IoError& e) {
    EXPECT_NE(std::string(e.what()).find("/no/such/program"), std::string::npos);
    EXPECT_EQ(e.error, ENOENT);
  }
  const auto nowhere = directory.path() / "missing" / "log";
  EXPECT_THROW(Process({.arguments = {"/bin/true"}}, nowhere, nowhere), talus::IoError);
}

TEST(Process, HasOnlyTheEnvironmentAndTheLimitsGiven) {
  const TemporaryDirectory directory;
  const auto out = directory.path() / "out", err = directory.path() / "err";
  Process process(
      {.arguments = {"sh", "-c", "sleep 0.05; env | grep -v -E '^(PWD|_|SHLVL)='; ulimit -f; ulimit -c; echo err >&2"},
       .environment = std::vector<std::string>{"A=1", "PATH=/usr/bin:/bin"},
       .limits = {.file_bytes = 1 << 20, .core_dumps = false}},
      out, err);
  EXPECT_EQ(wait_for(process).exit_code, 0);
  EXPECT_EQ(content(out), "A=1\nPATH=/usr/bin:/bin\n" + std::to_string((1 << 20) / 512) + "\n0\n");
  EXPECT_EQ(content(err), "err\n");
}

TEST(Process, TailIsTheEnd) {
  const TemporaryDirectory directory;
  const auto log = directory.path() / "log";
  write(log, "0123456789");
  EXPECT_EQ(tail(log, 4), "6789");
  EXPECT_EQ(tail(log, 40), "0123456789");
  EXPECT_EQ(tail(directory.path() / "none", 4), "");
  EXPECT_EQ(last_line("one\ntwo \n\n"), "two");
}

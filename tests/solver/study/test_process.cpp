#include <signal.h>

#include <chrono>
#include <thread>

#include "math/error.hpp"
#include "studies.hpp"
#include "study/process.hpp"

using namespace talus;
using namespace talus::fixtures;

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
  const auto log = directory.path / "log";
  Process process({"/bin/sh", "-c", "echo out; echo err >&2; exit 7"}, log);
  const ProcessEnd end = wait_for(process);
  EXPECT_EQ(end.exit_code, 7);
  EXPECT_EQ(end.signal, 0);
  EXPECT_EQ(content(log), "out\nerr\n");
  EXPECT_EQ(process.poll()->exit_code, 7);  // asking again is harmless
}

TEST(Process, SignalsReachItAndItsChildren) {
  const TemporaryDirectory directory;
  Process process({"/bin/sh", "-c", "sleep 100 & echo ready; wait"}, directory.path / "log");
  while (content(directory.path / "log").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  process.signal(SIGTERM);
  EXPECT_EQ(wait_for(process).signal, SIGTERM);
}

TEST(Process, IsKilledWithItsOwner) {
  const TemporaryDirectory directory;
  pid_t pid = 0;
  {
    const Process process({"/bin/sleep", "100"}, directory.path / "log");
    pid = process.pid();
    EXPECT_EQ(::kill(pid, 0), 0);
  }
  EXPECT_NE(::kill(pid, 0), 0);
}

TEST(Process, WhatCannotBeStartedIsNamed) {
  const TemporaryDirectory directory;
  try {
    Process({"/no/such/program"}, directory.path / "log");
    FAIL();
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("/no/such/program"), std::string::npos);
  }
  EXPECT_THROW(Process({"/bin/true"}, directory.path / "missing" / "log"), IoError);
}

TEST(Process, TailIsTheEnd) {
  const TemporaryDirectory directory;
  write(directory.path / "log", "0123456789");
  EXPECT_EQ(tail(directory.path / "log", 4), "6789");
  EXPECT_EQ(tail(directory.path / "log", 40), "0123456789");
  EXPECT_EQ(tail(directory.path / "none", 4), "");
}

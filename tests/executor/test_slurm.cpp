// The Slurm executor with stand-ins for Slurm's programs; the test plays the nodes. tests/slurm has the real one.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <thread>

#include "executor/slurm.hpp"
#include "files.hpp"

using namespace talus::executor;
using talus::test::content;
using talus::test::TemporaryDirectory;
using talus::test::write;
namespace fs = std::filesystem;

namespace {

class Slurm : public testing::Test {
 protected:
  Slurm() {
    program(
        "sbatch",
        "[ -e refuse ] && { echo 'sbatch: error: no such partition' >&2; exit 1; }\n"
        "for last; do :; done; echo \"$last\" > batch; printf '%s\\n' \"$@\" > arguments; echo call >> calls; echo 41");
    program("squeue", "[ \"$*\" = '--json --states=all' ] && cat queue.json || exit 1");
    program("scancel", "echo \"$@\" >> cancelled");
    ::setenv("PATH", (fake.path().string() + ":/usr/bin:/bin").c_str(), 1);
    config.poll_s = 0.05;
    queue("");
    make();
  }
  void program(const char* name, const std::string& script) {
    write(fake / name, "#!/bin/sh\ncd " + fake.path().string() + " || exit 9\n" + script + "\n");
    fs::permissions(fake / name, fs::perms::owner_all);
  }
  void queue(const std::string& jobs) {
    write(fake / "new.json", R"({"errors": [], "jobs": [)" + jobs + "]}");
    fs::rename(fake / "new.json", fake / "queue.json");
  }
  void state(const std::string& word) {
    queue(R"({"array_job_id": 41, "array_task_id": 0, "name": "talus-)" + batch().path().filename().string() +
          R"(", "job_state": ")" + word + "\"}");
  }
  void make() {
    executor.reset();
    executor.emplace(config, directory / "slurm", std::vector<std::string>{"/opt/talus", "array-task"}, 3,
                     [this](const std::string& text) { notes += text + "\n"; });
  }
  RunId start(const std::string& name) {
    return executor->start({.name = name,
                            .group = "g",
                            .command = {.arguments = {"/opt/talus", "run"}},
                            .directory = directory / name,
                            .log = directory / (name + ".log")});
  }
  BatchDirectory batch() const {
    std::string path = content(fake / "batch");
    return BatchDirectory(path.substr(0, path.find('\n')));
  }
  /// Polls until `condition`, at most 20 s.
  template <class Condition>
  void until(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << notes;
      for (Ended& how : executor->poll()) ended.push_back(std::move(how));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  void until_submitted() {
    until([&] { return fs::exists(fake / "batch") && batch().job(); });
  }
  void for_a_while() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    until([&] { return std::chrono::steady_clock::now() > end; });
  }
  int calls() const { return static_cast<int>(content(fake / "calls").size() / 5); }

  TemporaryDirectory fake, directory;
  SlurmConfig config;
  std::string notes;
  std::optional<SlurmExecutor> executor;
  std::vector<Ended> ended;
};

}  // namespace

TEST_F(Slurm, SubmitsAnArrayAndTellsHowItsRunsEnd) {
  config.partition = "long";
  config.sbatch_options = {"--qos=low"};
  make();
  const RunId a = start("a"), b = start("b");
  until_submitted();
  state("RUNNING");
  const std::string said = content(fake / "arguments");
  for (const char* argument :
       {"--parsable\n", "--array=0-1\n", "--requeue\n", "--signal=B:TERM@60\n", "--cpus-per-task=3\n",
        "--partition=long\n", "--qos=low\n", "task.sh\n/opt/talus\narray-task\n"})
    EXPECT_NE(said.find(argument), std::string::npos) << argument << said;
  EXPECT_EQ(said.find("--account"), std::string::npos);
  const BatchDirectory files = batch();
  EXPECT_EQ(content(files.script()), "#!/bin/sh\nexec \"$@\"\n");
  EXPECT_EQ(files.runs(1)->at(0).name, "b");
  files.write_status({1, 0}, {.end = {.exit_code = 4}, .resumed = true});
  files.write_status({0, 0}, {.end = {}, .seconds = 1.0});
  files.write_status({7, 0}, {});  // of nobody
  until([&] { return ended.size() == 2; });
  EXPECT_EQ(ended[0].id, a);
  EXPECT_EQ(ended[1].id, b);
  EXPECT_EQ(ended[1].end.exit_code, 4);
  EXPECT_TRUE(ended[1].resumed);
  until([&] { return !fs::exists(files.path()); });
  for_a_while();
  EXPECT_EQ(ended.size(), 2u);
}

TEST_F(Slurm, ALostNodeIsNotTheRunsFaultAndACancelledTaskMayBe) {
  for (const auto& [word, taken] : std::map<std::string, bool>{{"NODE_FAIL", true},
                                                               {"PREEMPTED", true},
                                                               {"COMPLETED", true},
                                                               {"CANCELLED", false},
                                                               {"TIMEOUT", false},
                                                               {"OUT_OF_MEMORY", false}}) {
    ended.clear();
    fs::remove(fake / "batch");
    queue(R"({"array_job_id": 41, "array_task_id": 0, "job_state": "PENDING"})");
    start("a");
    until_submitted();
    state("COMPLETING");
    for_a_while();
    EXPECT_TRUE(ended.empty());
    state(word);
    until([&] { return !ended.empty(); });
    EXPECT_EQ(ended[0].preempted, taken) << word;
    EXPECT_EQ(ended[0].end.signal, taken ? 0 : SIGKILL) << word;
  }
}

TEST_F(Slurm, AStatusCountsWhateverTheQueueSays) {
  start("a");
  until_submitted();
  batch().write_status({0, 0}, {.end = {.exit_code = 0}, .seconds = 1.0});
  state("CANCELLED");
  until([&] { return !ended.empty(); });
  EXPECT_FALSE(ended[0].preempted);
  EXPECT_EQ(ended[0].end.signal, 0);
}

TEST_F(Slurm, AQueueThatCannotBeReadSaysNothing) {
  start("a");
  until_submitted();
  write(fake / "queue.json", "slurm_load_jobs error: Unable to contact slurm controller");
  for_a_while();
  fs::remove(fake / "queue.json");
  for_a_while();
  EXPECT_TRUE(ended.empty());
  EXPECT_NE(notes.find("waiting for Slurm"), std::string::npos);
  state("RUNNING");
  until([&] { return notes.find("answers again") != std::string::npos; });
  EXPECT_TRUE(ended.empty());
  queue("");
  until([&] { return !ended.empty(); });
  EXPECT_NE(ended[0].why.find("forgotten"), std::string::npos);
}

TEST_F(Slurm, RefusedItTriesAgainAndAtLastSaysSo) {
  write(fake / "refuse", "");
  start("a");
  try {
    until([] { return false; });
    FAIL();
  } catch (const talus::IoError& e) {
    EXPECT_NE(std::string(e.what()).find("no such partition"), std::string::npos);
  }
  fs::remove(fake / "refuse");
  until_submitted();
  EXPECT_EQ(batch().runs(0)->at(0).name, "a");
}

TEST_F(Slurm, TheNextOneTakesOverWhatRunsOn) {
  start("a");
  start("b");
  until_submitted();
  queue(R"({"array_job_id": 41, "array_task_id": null, "array_task_string": "0-1", "job_state": "PENDING"})");
  const BatchDirectory files = batch();
  files.write_status({1, 0}, {.end = {.signal = 11}});  // its end is not known to have been told: it runs again
  make();
  const RunId a = start("a"), b = start("b");
  until([&] { return calls() == 2; });
  EXPECT_EQ(batch().runs(0)->at(0).name, "b");
  files.write_status({0, 0}, {.end = {}, .seconds = 1.0});
  until([&] { return ended.size() == 1; });
  EXPECT_EQ(ended[0].id, a);
  batch().write_status({0, 0}, {.end = {}, .seconds = 1.0});
  until([&] { return ended.size() == 2; });
  EXPECT_EQ(ended[1].id, b);
}

TEST_F(Slurm, AnAnswerOfSbatchThatNobodyHeard) {
  start("a");
  until_submitted();
  const BatchDirectory files = batch();
  state("RUNNING");
  fs::remove(files.path() / "job");
  make();
  start("a");
  until([&] { return files.job() == 41; });  // found by its name
  EXPECT_TRUE(ended.empty());
  fs::remove(files.path() / "job");
  queue("");
  make();
  start("a");
  until([&] { return !ended.empty(); });  // Slurm never got it
  EXPECT_TRUE(ended[0].preempted);
  until([&] { return !fs::exists(files.path()); });
  EXPECT_EQ(calls(), 1);
}

TEST_F(Slurm, SaysWhyNothingRuns) {
  const auto task = [](int index, const std::string& word, const std::string& reason) {
    return R"({"array_job_id": 41, "array_task_id": )" + std::to_string(index) + R"(, "job_state": ")" + word +
           R"(", "state_reason": ")" + reason + "\"}";
  };
  start("a");
  start("b");
  EXPECT_EQ(executor->pending_reason("g"), "");
  until_submitted();
  queue(task(0, "PENDING", "Resources") + "," + task(1, "PENDING", "JobHeldUser"));
  until([&] { return executor->pending_reason("g") == "waits in Slurm's queue: JobHeldUser, Resources"; });
  EXPECT_EQ(executor->pending_reason("h"), "");
  queue(task(0, "RUNNING", "None") + "," + task(1, "PENDING", "JobHeldUser"));
  until([&] { return executor->pending_reason("g").empty(); });
  batch().write_status({0, 0}, {.end = {}, .seconds = 1.0});
  queue(task(1, "PENDING", "JobHeldUser"));
  until([&] { return executor->pending_reason("g") == "waits in Slurm's queue: JobHeldUser"; });
  EXPECT_EQ(ended.size(), 1u);
}

TEST_F(Slurm, TakesFewRunsWhileNobodyKnowsHowLongTheyTake) {
  int taken = 0;
  while (executor->has_room() && taken < 1000) start("r" + std::to_string(taken++));
  EXPECT_EQ(taken, 8);
  until_submitted();
  queue(R"({"array_job_id": 41, "array_task_id": null, "array_task_string": "0-7", "job_state": "RUNNING"})");
  EXPECT_FALSE(executor->has_room());
  for (std::size_t i = 0; i < 8; ++i) batch().write_status({i, 0}, {.end = {}, .seconds = 1.0});
  until([&] { return ended.size() == 8; });
  fs::remove(fake / "batch");
  while (executor->has_room() && taken < 1000) start("r" + std::to_string(taken++));
  EXPECT_EQ(taken, 1000);
  until_submitted();
  EXPECT_EQ(batch().runs(0)->size(), 10u);  // 10 s of work a task
  EXPECT_EQ(batch().runs(99)->size(), 992u - 99u * 10u);
}

TEST_F(Slurm, KillsAndStops) {
  const RunId a = start("a");
  start("b");
  until_submitted();
  queue(R"({"array_job_id": 41, "array_task_id": null, "array_task_string": "0-1", "job_state": "RUNNING"})");
  executor->kill(a);
  EXPECT_TRUE(batch().is_killed({0, 0}));
  until([&] { return content(fake / "cancelled").find("41_0\n") != std::string::npos; });
  EXPECT_EQ(content(fake / "cancelled").find("41_1"), std::string::npos);
  executor->stop_all();
  until([&] { return content(fake / "cancelled").find("41_0 41_1\n") != std::string::npos; });
  queue("");
  until([&] { return ended.size() == 2; });
  EXPECT_FALSE(executor->has_room());
}

// A study whose workers are killed, hang or take too long, and one that is killed itself.

#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <random>

#include "executor/process.hpp"
#include "fake_study.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The processes that this one has started and not reaped.
std::vector<pid_t> children() {
  std::ifstream file("/proc/self/task/" + std::to_string(::getpid()) + "/children");
  return {std::istream_iterator<pid_t>(file), {}};
}

}  // namespace

TEST(StudyKills, AKilledWorkerIsTriedAgain) {
  Study s(5, "1=kill-once,3=kill,4=stop-once");
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin 1 "), 2);
  EXPECT_EQ(s.count("begin 3 "), 2);
  EXPECT_EQ(s.count("begin 4 resumed"), 1);
  const std::vector<Record> all = s.records();
  EXPECT_TRUE(all[1].done);
  EXPECT_TRUE(all[4].done);
  EXPECT_EQ(all[3].reason, "killed: Killed (signal 9), 2 times: starting");
  EXPECT_EQ(json::parse(content(s.out / "runs" / "000003.failed.json"))["signal"], 9);
}

TEST(StudyKills, AHangingWorkerIsEndedAndItsRealizationRunAgain) {
  Study s(4, "1=hang-once,3=hang");
  s.options.stall_limit_s = 1;
  Progress last;
  s.options.report = [&](const Progress& progress) { last = progress; };
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin 1 fresh"), 1);
  EXPECT_EQ(s.count("begin 1 resumed"), 1);
  EXPECT_EQ(s.count("begin 3 "), 2);
  EXPECT_TRUE(s.records()[1].done);
  EXPECT_EQ(s.records()[3].reason, "hung: no CPU time used for 1 s, 2 times: starting");
  EXPECT_NE(s.text_of_notes().find("realization 1: hung: no CPU time used for 1 s"), std::string::npos);
  EXPECT_EQ(last.run_again, 2);
}

TEST(StudyKills, ARunBeyondItsTimeLimitFails) {
  Study s(3, "1=after-9");
  s.options.time_limit_s = 1;
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin 1 "), 1);
  EXPECT_EQ(s.records()[1].reason.substr(0, 34), "took longer than the limit of 1 s");
  EXPECT_TRUE(s.records()[2].done);
}

TEST(StudyKills, AHundredKilledWorkersChangeNothing) {
  Study whole(40);
  whole.plan.study.noise_floor_replicates = 2;
  whole.run();
  std::mt19937 random(1);
  for (int kills = 0; kills < 100;) {  // as many studies as that takes
    Study s(40);
    s.plan.study.noise_floor_replicates = 2;
    s.options.attempts = 200;
    s.milliseconds = 10;
    const int before = kills;
    s.options.interrupts = [&] {  // called at every poll
      const std::vector<pid_t> workers = children();
      const bool spare = kills > before && (kills == 100 || random() % 2 == 0);
      if (workers.empty() || spare) return 0;
      ::kill(workers[random() % workers.size()], SIGKILL);
      ++kills;
      return 0;
    };
    ASSERT_EQ(s.run(), StudyEnd::finished);
    ASSERT_GT(kills, before);
    EXPECT_EQ(s.summary()["realizations"]["failed"], 0);
    EXPECT_EQ(content(s.out / "study.json"), content(whole.out / "study.json"));
    EXPECT_EQ(content(s.out / "realizations.csv"), content(whole.out / "realizations.csv"));
  }
}

namespace {

/// Starts the study of `s` as a process, kills it with SIGKILL once `begun` runs have begun, and finishes it
/// here.
void kill_and_finish(Study& s, int begun) {
  std::vector<std::string> command{STUDY_PROCESS, s.out.string(), std::to_string(s.plan.study.realizations), "3"};
  for (const std::string& word : s.program()) command.push_back(word);
  {
    executor::Process study({.arguments = command}, s.directory / "log", s.directory / "log");
    wait_until([&] { return s.count("begin ") >= begun; });
    ASSERT_FALSE(study.poll()) << content(s.directory / "log");
    study.signal(SIGKILL);
    wait_until([&] { return study.poll().has_value(); });
    EXPECT_EQ(study.poll()->signal, SIGKILL);
  }
  EXPECT_EQ(s.run(), StudyEnd::finished);
}

}  // namespace

TEST(StudyKills, SurvivesKill9) {
  Study s(20), whole(20);
  s.plan.study.noise_floor_replicates = whole.plan.study.noise_floor_replicates = 2;
  s.plan.study.max_failed_share = whole.plan.study.max_failed_share = 0.1;
  s.milliseconds = 15;
  kill_and_finish(s, 10);
  whole.run();
  EXPECT_EQ(content(s.out / "study.json"), content(whole.out / "study.json"));
  EXPECT_EQ(content(s.out / "realizations.csv"), content(whole.out / "realizations.csv"));
  EXPECT_LE(s.most_ends(), 1);  // none that had ended was run again
}

TEST(StudyKills, AdoptsWhatItsOrphansFinish) {
  Study s(12, "orphan");
  s.plan.study.noise_floor_replicates = 2;
  s.plan.study.max_failed_share = 0.1;
  s.milliseconds = 300;  // much longer than the next study needs to begin
  kill_and_finish(s, 6);
  EXPECT_EQ(s.count("begin "), 14);  // workers outlived the study, and nothing at all was started twice
  EXPECT_NE(s.text_of_notes().find("taken over"), std::string::npos);
}

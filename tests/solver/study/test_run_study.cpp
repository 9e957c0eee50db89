// The study against fake_run. What ends its workers or the study itself from outside: test_study_kills.cpp.

#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <thread>

#include "fake_study.hpp"
#include "support/error.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

bool no_locks = false;  ///< as on a file system that has none

}  // namespace

extern "C" int flock(int file, int operation) {
  if (!no_locks) return static_cast<int>(::syscall(SYS_flock, file, operation));
  errno = ENOLCK;
  return -1;
}

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

}  // namespace

TEST(RunStudy, RunsEveryRealizationOnce) {
  Study s(12);
  s.plan.study.noise_floor_replicates = 3;
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.records().size(), 12u);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(s.count("begin " + std::to_string(i) + " fresh"), 1);
  for (const char* e : {"1e-06", "2e-06", "3e-06"}) EXPECT_EQ(s.count(std::string("begin floor") + e), 1) << e;
  EXPECT_EQ(s.summary()["realizations"]["done"], 12);
  EXPECT_EQ(s.summary()["noise_floor"]["replicates_done"], 3);
  EXPECT_EQ(s.summary()["realizations"]["complete"], true);
  EXPECT_FALSE(fs::exists(s.out / "work"));
  EXPECT_TRUE(fs::exists(s.out / "runs" / "000011.json"));
  EXPECT_TRUE(fs::exists(s.out / "floor" / "3.json"));
  EXPECT_EQ(json::parse(content(s.out / "case.resolved.json"))["study"]["realizations"], 12);
}

TEST(RunStudy, ResultsDoNotDependOnTheWorkers) {
  Study one(15, "4=diverge"), many(15, "4=diverge");
  one.plan.study.noise_floor_replicates = many.plan.study.noise_floor_replicates = 2;
  one.options.workers = 1;
  many.options.workers = 7;
  one.run();
  many.run();
  for (const char* file :
       {"realizations.csv", "noise_floor.csv", "study.json", "profiles/first.vtkhdf", "profiles/worst.vtkhdf"}) {
    EXPECT_FALSE(content(one.out / file).empty()) << file;
    EXPECT_EQ(content(one.out / file), content(many.out / file)) << file;
  }
}

TEST(RunStudy, KeepsTheFirstAndTheFarthestProfile) {
  Study s(9);
  s.run();
  const std::int64_t farthest = s.summary()["extremes"]["farthest_realization"];
  EXPECT_NE(farthest, 0);
  EXPECT_EQ(content(s.out / "profiles" / "first.vtkhdf"), "profile of 0");
  EXPECT_EQ(content(s.out / "profiles" / "worst.vtkhdf"), "profile of " + std::to_string(farthest));
  EXPECT_EQ(json::parse(content(s.out / "profiles" / "worst.json"))["realization"], farthest);
}

TEST(RunStudy, AFinishedStudyIsNotRunAgain) {
  Study s(5);
  s.run();
  const std::string csv = content(s.out / "realizations.csv"), diary = content(s.diary);
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(content(s.diary), diary);
  EXPECT_EQ(content(s.out / "realizations.csv"), csv);
}

TEST(RunStudy, MoreRealizationsExtendIt) {
  Study s(5), whole(9);
  s.run();
  s.plan.study.realizations = 9;
  EXPECT_EQ(s.run(), StudyEnd::finished);
  whole.run();
  EXPECT_EQ(s.count("begin"), 9);
  EXPECT_EQ(content(s.out / "study.json"), content(whole.out / "study.json"));
}

TEST(RunStudy, AnotherStudyIsRefused) {
  Study s(5);
  s.run();
  s.plan.seed = 43;
  EXPECT_THROW(s.run(), IoError);
  s.plan.seed = 42;
  s.plan.of.hash = "fedcba9876543210";
  EXPECT_THROW(s.run(), IoError);
}

TEST(RunStudy, FailuresAreRecordedAndStayInTheDenominator) {
  Study s(8, "2=diverge,5=internal,6=no-result");
  EXPECT_EQ(s.run(), StudyEnd::finished);
  const std::vector<Record> all = s.records();
  ASSERT_EQ(all.size(), 8u);
  EXPECT_EQ(all[2].reason, "diverged: diverged at step 12, particle 7");
  EXPECT_EQ(all[5].reason, "exit code 1: starting");
  EXPECT_EQ(all[6].reason, "it ended well but left no readable result, 2 times: starting");
  const json why = json::parse(content(s.out / "runs" / "000002.failed.json"));
  EXPECT_EQ(why["exit_code"], 4);
  EXPECT_TRUE(why["signal"].is_null());
  EXPECT_EQ(why["log_tail"], "starting\ndiverged at step 12, particle 7\n");
  EXPECT_EQ(s.summary()["realizations"]["failed"], 3);
  EXPECT_EQ(s.summary()["quantities"]["influence_zone_m"]["exceedance"][0]["n"], 8);
  s.run();
  EXPECT_EQ(s.count("begin 2 "), 1);  // never drawn again by itself
}

TEST(RunStudy, AnInvalidResultCountsAsAFailedRunAndADoubtfulOneIsKept) {
  Study s(8, "2=invalid,3=doubtful,4=doubtful");
  EXPECT_EQ(s.run(), StudyEnd::finished);
  const std::vector<Record> all = s.records();
  ASSERT_EQ(all.size(), 8u);
  EXPECT_FALSE(all[2].done);
  EXPECT_EQ(all[2].reason, "invalid result: still_moving: it moves");
  EXPECT_EQ(all[2].verdict, Verdict::invalid);
  EXPECT_TRUE(all[3].done);
  EXPECT_EQ(all[3].verdict, Verdict::doubtful);
  EXPECT_EQ(all[3].objections, "still_moving: it moves");
  EXPECT_FALSE(fs::exists(s.out / "runs" / "000002.json"));
  EXPECT_EQ(json::parse(content(s.out / "runs" / "000002.failed.json"))["reason"], all[2].reason);
  EXPECT_EQ(s.summary()["realizations"]["failed"], 1);
  EXPECT_EQ(s.summary()["quantities"]["influence_zone_m"]["exceedance"][0]["n"], 8);
  EXPECT_EQ(s.summary()["quality"]["invalid"], 1);
  EXPECT_EQ(s.summary()["quality"]["doubtful"], 2);
  const std::string tables = content(s.out / "realizations.csv") + content(s.out / "study.json");
  s.run();  // from the records on disk
  EXPECT_EQ(content(s.out / "realizations.csv") + content(s.out / "study.json"), tables);
  EXPECT_EQ(s.count("begin 2 "), 1);
}

TEST(RunStudy, AnInvalidResultThatAKilledStudyLeftIsAFailedRun) {
  Study s(3, "1=invalid");
  s.run();
  const fs::path left = s.out / "work" / "000001";
  fs::create_directories(left);
  fs::remove(s.out / "runs" / "000001.failed.json");
  json result = json::parse(content(s.out / "runs" / "000000.json"));
  result["provenance"]["realization"] = 1;
  result["quality"] = {{"verdict", "invalid"}, {"reasons", {{{"check", "a"}, {"message", "b"}}}}};
  write(left / "result.json", result.dump());
  s.run();
  EXPECT_EQ(s.records().at(1).reason, "invalid result: a: b");
  EXPECT_EQ(s.count("begin 1 "), 1);
}

TEST(RunStudy, FailedOnesAreTriedAgainWhenAsked) {
  Study s(6, "2=diverge");
  s.run();
  s.script = "ok";
  s.options.retry_failed = true;
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin 2 "), 2);
  EXPECT_EQ(s.count("begin"), 7);
  EXPECT_EQ(s.summary()["realizations"]["failed"], 0);
  EXPECT_FALSE(fs::exists(s.out / "runs" / "000002.failed.json"));
}

TEST(RunStudy, ABadCheckpointIsNotTheEnd) {
  Study s(4, "2=bad-checkpoint");
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin 2 fresh"), 2);
  EXPECT_EQ(s.count("begin 2 resumed"), 1);
  EXPECT_EQ(s.summary()["realizations"]["done"], 4);
}

TEST(RunStudy, TooManyFailuresEndIt) {
  Study s(40, "0=diverge,1=diverge,2=diverge,3=diverge,4=diverge");
  s.plan.study.max_failed_share = 0.1;
  s.options.workers = 1;
  EXPECT_EQ(s.run(), StudyEnd::too_many_failed);
  EXPECT_EQ(s.summary()["realizations"]["failed"], 5);
  EXPECT_LT(s.count("begin"), 8);
  EXPECT_EQ(s.run(), StudyEnd::too_many_failed);
  EXPECT_LT(s.count("begin"), 8);
}

TEST(RunStudy, ABadCaseOrAFullDiskEndsItWithoutARecord) {
  Study bad(6, "2=bad-case");
  try {
    bad.run();
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("/material: is bad"), std::string::npos);
  }
  Study full(6, "2=full");
  full.options.workers = 1;
  full.options.attempts = 1;
  try {
    full.run();
    FAIL();
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("No space left on device"), std::string::npos);
  }
  full.script = "ok";
  EXPECT_EQ(full.run(), StudyEnd::finished);
  EXPECT_EQ(full.count("begin 0 "), 1);
  EXPECT_EQ(full.count("begin 2 "), 2);
  EXPECT_EQ(full.summary()["realizations"]["done"], 6);
}

TEST(RunStudy, AResultOfSomethingElseIsNeverTaken) {
  Study s(4, "2=wrong");
  EXPECT_THROW(s.run(), IoError);
}

TEST(RunStudy, StopsEarlyAtTheSameRealizationWhateverTheWorkers) {
  // Number 8 waits until the others have run far ahead of where the study will stop.
  Study one(200), many(200, "8=after-50");
  one.plan.study.stop_half_width = many.plan.study.stop_half_width = 0.25;
  one.plan.study.noise_floor_replicates = many.plan.study.noise_floor_replicates = 2;
  one.options.workers = 1;
  many.options.workers = 9;
  EXPECT_EQ(one.run(), StudyEnd::stopped_early);
  EXPECT_EQ(many.run(), StudyEnd::stopped_early);
  EXPECT_LT(one.count("end "), 50);
  EXPECT_GT(many.count("end "), 50);
  EXPECT_EQ(content(one.out / "study.json"), content(many.out / "study.json"));
  const json n = one.summary()["realizations"];
  EXPECT_EQ(n["planned"], 200);
  EXPECT_EQ(n["stopped_early"], true);
  EXPECT_EQ(n["complete"], true);
  EXPECT_GE(n["done"], 10);
  EXPECT_LT(n["done"], 60);
  const json ci = one.summary()["quantities"]["influence_zone_m"]["mean_ci95"];
  EXPECT_LE(ci[1].get<double>() - ci[0].get<double>(), 2 * 0.25);
  EXPECT_EQ(one.summary()["noise_floor"]["replicates_done"], 2);
}

TEST(RunStudy, AskedToStopItCheckpointsAndGoesOn) {
  Study s(12, "1=after-11");  // still in mid-run whenever the others make the study stop
  s.milliseconds = 40;
  int asked = 0;
  s.options.interrupts = [&] { return asked; };
  s.options.report = [&](const Progress& p) { asked = p.done >= 3 ? 1 : 0; };
  EXPECT_EQ(s.run(), StudyEnd::interrupted);
  const int ended = s.count("end");
  EXPECT_LT(ended, 12);
  EXPECT_EQ(static_cast<int>(s.records().size()), ended);
  asked = 0;
  s.options.report = {};
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_GE(s.count("begin ") - s.count("end "), 1);  // those stopped half way
  int resumed = 0;
  for (int i = 0; i < 12; ++i) resumed += s.count("begin " + std::to_string(i) + " resumed");
  EXPECT_GE(resumed, 1);
  EXPECT_EQ(s.count("end "), 12);
}

TEST(RunStudy, AShareOfTheRealizationsCanBeRunElsewhere) {
  Study s(10);
  s.plan.study.noise_floor_replicates = 2;
  s.options.first = 4;
  s.options.last = 7;
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin"), 3);
  EXPECT_EQ(s.summary()["realizations"]["missing"].dump(), "[[0,3],[7,9]]");
  EXPECT_EQ(s.summary()["realizations"]["planned"], 10);
}

TEST(RunStudy, TwoStudiesDoNotShareADirectory) {
  Study s(3);
  s.milliseconds = 20;
  bool tried = false;
  s.options.report = [&](const Progress&) {
    if (std::exchange(tried, true)) return;
    RunStudyOptions other = s.options;
    other.report = {};
    EXPECT_THROW(run_study(s.plan, {}, s.out, other), IoError);
  };
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_TRUE(tried);
  EXPECT_EQ(s.count("begin"), 3);
}

TEST(RunStudy, GoesOnWhereTheFileSystemHasNoLocks) {
  Study s(5), whole(5);
  no_locks = true;
  EXPECT_EQ(s.run(), StudyEnd::finished);
  no_locks = false;
  EXPECT_NE(s.text_of_notes().find("has no locks: do not start a second study in " + s.out.string()), std::string::npos)
      << s.text_of_notes();
  whole.run();
  EXPECT_EQ(content(s.out / "study.json"), content(whole.out / "study.json"));
  EXPECT_EQ(whole.text_of_notes(), "");
}

TEST(RunStudy, ADamagedResultIsRunAgain) {
  Study s(4);
  s.run();
  write(s.out / "runs" / "000002.json", "{\"influence_zone_m\": 3");
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin 2 "), 2);
  EXPECT_EQ(s.count("begin "), 5);
}

TEST(RunStudy, ADamagedProfileIsMadeAgain) {
  Study s(6);
  s.run();
  const std::string farthest = json::parse(content(s.out / "profiles" / "worst.json"))["realization"].dump();
  ASSERT_NE(farthest, "0");
  for (const auto& [profile, index] : {std::pair{"first", std::string("0")}, {"worst", farthest}}) {
    const fs::path snapshots = s.out / "profiles" / (std::string(profile) + ".vtkhdf");
    const std::string whole = content(snapshots), results = content(s.out / "realizations.csv");
    for (const bool missing : {false, true}) {
      const int before = s.count("begin ");
      fs::remove(snapshots);
      if (!missing) write(snapshots, "other than it was");
      EXPECT_TRUE(is_damaged_profile({s.out}, profile));
      EXPECT_EQ(s.run(), StudyEnd::finished);
      EXPECT_EQ(content(snapshots), whole);
      EXPECT_EQ(content(s.out / "realizations.csv"), results);
      EXPECT_EQ(s.count("begin "), before + 1);
      EXPECT_FALSE(is_damaged_profile({s.out}, profile));
    }
    EXPECT_EQ(s.count("begin " + index + " "), 3);
  }
  EXPECT_NE(s.text_of_notes().find("the kept profile of realization 0 is damaged; running it again"),
            std::string::npos);
}

TEST(RunStudy, AProfileOfAnEarlierVersionIsLeftAlone) {  // without a hash
  Study s(3);
  s.run();
  fs::remove(s.out / "profiles" / "first.json");
  write(s.out / "profiles" / "worst.json", with_checksum({{"realization", 1}, {"influence_zone_m", 35.2}}));
  write(s.out / "profiles" / "first.vtkhdf", "other");
  const int before = s.count("begin ");
  EXPECT_EQ(s.run(), StudyEnd::finished);
  EXPECT_EQ(s.count("begin "), before);
}

TEST(RunStudy, AResultWithANumberThatNoRunHasIsRunAgain) {
  Study s(3);
  s.run();
  const fs::path result = s.out / "runs" / "000001.json";
  for (const auto& [key, value] : {std::pair{"influence_zone_m", Json(1e300)}, {"steps", Json(2'000'000'000'000)}}) {
    Json changed = Json::parse(content(result));
    changed.erase("checksum");
    changed[key] = value;
    write(result, with_checksum(changed));
    const int before = s.count("begin 1 ");
    EXPECT_EQ(s.run(), StudyEnd::finished);
    EXPECT_EQ(s.count("begin 1 "), before + 1) << key;
  }
}

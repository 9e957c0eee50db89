#include <gtest/gtest.h>

#include <cmath>

#include "schema_check.hpp"
#include "studies.hpp"
#include "study/publish.hpp"
#include "study/quality_summary.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

Record sound(std::int64_t index) {
  Record r = done(index, 34.0 + 0.1 * static_cast<double>(index));
  r.verdict = Verdict::sound;
  return r;
}

Record doubtful(std::int64_t index, const std::string& objections) {
  Record r = sound(index);
  r.verdict = Verdict::doubtful;
  r.objections = objections;
  return r;
}

/// Replicates that differ from realization 0, at 34 m, by steps of `step` [m].
std::vector<Record> replicates(double step) {
  std::vector<Record> all;
  for (int k = 1; k <= 4; ++k) all.push_back(done(k, 34.0 + step * k));
  return all;
}

}  // namespace

TEST(QualitySummary, CountsVerdictsAndReasons) {
  const Json study = summarize(
      plan(7),
      {sound(0), doubtful(1, "still_moving: at 3 %"), doubtful(2, "left_terrain: 4 of 9; still_moving: at 5 %"),
       failed_record(3, "invalid result: mach_number: 0.7 times; still_moving: at 90 %"), done(4, 34.0),
       failed(5, "diverged")},
      {});
  const Json& quality = study.at("quality");
  EXPECT_EQ(quality["verdict"], "doubtful");
  EXPECT_EQ(quality["sound"], 1);
  EXPECT_EQ(quality["doubtful"], 2);
  EXPECT_EQ(quality["invalid"], 1);
  EXPECT_EQ(quality["not_assessed"], 1);
  EXPECT_EQ(study["realizations"]["failed"], 2);  // the invalid one is in the denominator
  const Json expected = {{{"check", "still_moving"}, {"runs", 3}, {"example", "at 3 %"}},
                         {{"check", "left_terrain"}, {"runs", 1}, {"example", "4 of 9"}},
                         {{"check", "mach_number"}, {"runs", 1}, {"example", "0.7 times"}}};
  EXPECT_EQ(quality["reasons"], expected);
  EXPECT_EQ(quality_line(quality),
            "2 of 5 runs doubtful, 1 invalid, 1 not assessed: still moving (3), left terrain (1), mach number (1)");
  static const test::SchemaCheck schema("study");
  EXPECT_EQ(schema.complaint(nlohmann::json(study)), "");
}

TEST(QualitySummary, ASoundStudySaysNothing) {
  const Json quality = summarize(plan(3), {sound(0), sound(1), sound(2)}, {}).at("quality");
  EXPECT_EQ(quality["verdict"], "sound");
  EXPECT_EQ(quality_line(quality), "");
}

TEST(QualitySummary, RunsOfAnEarlierVersionAreNotAssessed) {
  const Json quality = summarize(plan(2), {done(0, 34.0), done(1, 35.0)}, {}).at("quality");
  EXPECT_EQ(quality["verdict"], "not_assessed");
  EXPECT_EQ(quality_line(quality), "2 of 2 runs not assessed");
}

TEST(QualitySummary, NoiseAboveAThirdOfTheSpreadMakesTheStudyDoubtful) {
  // The spread of 34, 34.1, 34.2 is 0.1 m; the noise of 34 and its replicates is sqrt(2.5) steps.
  const std::vector<Record> runs{sound(0), sound(1), sound(2)};
  const double limit = 0.1 / 3.0 / std::sqrt(2.5);
  EXPECT_EQ(summarize(plan(3), runs, replicates(0.99 * limit)).at("quality").at("verdict"), "sound");
  const Json quality = summarize(plan(3), runs, replicates(1.01 * limit)).at("quality");
  EXPECT_EQ(quality["verdict"], "doubtful");
  EXPECT_EQ(quality["reasons"][0]["check"], "noise_near_spread");
  EXPECT_EQ(quality_line(quality),
            "study doubtful: the farthest particle has a standard deviation of 0.1 m, its numerical noise 0.0337 m, "
            "more than a third of it");
}

TEST(QualitySummary, TheTablesGiveItAgain) {
  const TemporaryDirectory d;
  const Plan p = plan(4);
  const std::vector<Record> runs{sound(0), doubtful(1, "left_terrain: 4 of 9; still_moving: at 5 %"),
                                 failed_record(2, "invalid result: mach_number: 0.7 times"), done(3, 35.0)};
  write(d / "t.csv", "");
  write_plan(d.path(), p);
  write_tables({d.path()}, p, runs, {});
  const Tables back = read_tables(d.path());
  EXPECT_EQ(summarize(back.plan, back.runs, back.floor).at("quality"), summarize(p, runs, {}).at("quality"));
}

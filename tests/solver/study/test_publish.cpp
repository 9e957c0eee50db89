#include <cmath>

#include "studies.hpp"
#include "study/publish.hpp"
#include "study/run_study.hpp"
#include "study/summary.hpp"
#include "support/error.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

namespace fs = std::filesystem;

/// A study's tables in a new directory.
fs::path study(const fs::path& directory, const Plan& p, const std::vector<Record>& runs,
               const std::vector<Record>& floor = {}) {
  fs::create_directories(directory);
  write_plan(directory, p);
  write_tables(StudyPaths{directory}, p, runs, floor);
  return directory;
}

std::string refusal(const std::vector<fs::path>& directories) {
  try {
    merge(directories);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST(Tables, GiveStudyJsonAgain) {
  const TemporaryDirectory d;
  Plan p = plan(6);
  p.study.noise_floor_replicates = 2;
  p.study.histogram_edges = {30.0, 34.0, 38.0};
  study(d.path(), p, {done(0, 100.0 / 3.0), done(1, 35.1), failed(2, "diverged: x, \"y\""), done(4, 36.7)},
        {done(1, 33.4), done(2, 33.3)});
  const Tables back = read_tables(d.path());
  EXPECT_EQ(with_checksum(summarize(back.plan, back.runs, back.floor)), content(d / "study.json"));
}

TEST(Tables, WhatIsNoStudyIsRefused) {
  const TemporaryDirectory d;
  EXPECT_THROW(read_tables(d.path()), IoError);
  study(d.path(), plan(3), {done(0, 1.0), done(3, 2.0)});  // index 3 of 3
  EXPECT_THROW(read_tables(d.path()), IoError);
}

TEST(Merge, JoinsStudiesAndKeepsGaps) {
  const TemporaryDirectory d;
  const auto a = study(d / "a", plan(6), {done(0, 34.0), done(1, 35.0), failed(3, "killed")}, {done(1, 34.1)});
  const auto b = study(d / "b", plan(8), {done(1, 35.0), done(3, 36.0), done(7, 37.0)}, {done(2, 34.2)});
  const Tables all = merge({a, b});
  ASSERT_EQ(all.runs.size(), 4u);
  EXPECT_EQ(all.runs[2].index, 3);
  EXPECT_TRUE(all.runs[2].done);  // it failed on one machine only
  EXPECT_EQ(all.floor.size(), 2u);
  EXPECT_EQ(all.plan.study.realizations, 8);
  EXPECT_EQ(summarize(all.plan, all.runs, all.floor)["realizations"]["missing"].dump(), "[[2,2],[4,6]]");
  const Tables turned = merge({b, a});
  EXPECT_EQ(summarize(all.plan, all.runs, all.floor), summarize(turned.plan, turned.runs, turned.floor));
}

TEST(Merge, NamesARealizationWithTwoResults) {
  const TemporaryDirectory d;
  Record other = done(1, 35.0);
  other.digest = "ffffffffffffffff";
  const auto a = study(d / "a", plan(6), {done(0, 34.0), done(1, 35.0)});
  const auto b = study(d / "b", plan(6), {other});
  const std::string text = refusal({a, b});
  EXPECT_NE(text.find("realization 1 has two results: the digest is 0000000000000011 in an earlier directory and "
                      "ffffffffffffffff in " +
                      b.string()),
            std::string::npos)
      << text;
}

TEST(Merge, NamesEveryDifference) {
  const TemporaryDirectory d;
  Plan other = plan(6);
  other.seed = 7;
  other.of.hash = "fedcba9876543210";
  other.version = "9.9.9";
  const auto a = study(d / "a", plan(6), {done(0, 34.0)});
  const auto b = study(d / "b", other, {done(1, 35.0)});
  const std::string text = refusal({a, b});
  EXPECT_NE(text.find("the case hash is fedcba9876543210 there, not 0123456789abcdef"), std::string::npos) << text;
  EXPECT_NE(text.find("the seed is 7 there, not 42"), std::string::npos) << text;
  EXPECT_NE(text.find("the version of Talus is 9.9.9 there, not 0.1.0"), std::string::npos) << text;
}

TEST(Merge, LatinHypercubesMustBeOne) {
  const TemporaryDirectory d;
  Plan six = plan(6), eight = plan(8);
  six.study.sampling = eight.study.sampling = Sampling::latin_hypercube;
  const auto a = study(d / "a", six, {done(0, 34.0)});
  const auto b = study(d / "b", eight, {done(1, 35.0)});
  EXPECT_NE(refusal({a, b}).find("size of the Latin hypercube is 8 there, not 6"), std::string::npos);
  EXPECT_EQ(refusal({a, study(d / "c", six, {done(1, 35.0)})}), "accepted");
}

TEST(Merge, WritesAStudyThatCanBeMergedAgainButNotRun) {
  const TemporaryDirectory d;
  const auto a = study(d / "a", plan(3), {done(0, 34.0)});
  const auto b = study(d / "b", plan(3), {done(1, 35.0)});
  write(a / "case.resolved.json", "{}");
  for (int again = 0; again < 2; ++again) write_merged(d / "all", merge({a, b}), a);
  EXPECT_EQ(read_tables(d / "all").runs.size(), 2u);
  EXPECT_EQ(content(d / "all" / "case.resolved.json"), "{}");
  EXPECT_THROW(run_study(plan(3), {}, d / "all", {}), IoError);
  fs::create_directories(b / "runs");
  EXPECT_THROW(write_merged(b, merge({a, b}), a), IoError);
  fs::create_directories(d / "foreign");
  write(d / "foreign" / "thesis.tex", "x");
  EXPECT_THROW(write_merged(d / "foreign", merge({a, b}), a), IoError);
  EXPECT_FALSE(fs::exists(d / "foreign" / "study.json"));
}

TEST(Tables, EndWhereTheStudyStopped) {
  const TemporaryDirectory d;
  Plan p = plan(100);
  std::vector<Record> runs;
  for (int i = 0; i < 14; ++i) runs.push_back(done(i, 34.0));
  EXPECT_EQ(read_tables(study(d / "all", p, runs)).runs.size(), 14u);
  p.study.stop_half_width = 1.0;
  EXPECT_EQ(read_tables(study(d / "stopped", p, runs)).runs.size(), 10u);
}

TEST(RunRecord, AMeasureThatTheRunHasNotHasNoValue) {
  const TemporaryDirectory directory;
  Json result = {{"digest", "d"},
                 {"ending", "end_time"},
                 {"at_rest", true},
                 {"steps", 1},
                 {"wall_clock_s", 1.0},
                 {"front_at_thickness_m", nullptr},
                 {"front_thickness_m", 0.6},
                 {"field", {{"mean_friction_angle_deg", 25.0}, {"captured_variance", 1.0}}},
                 {"provenance", {{"seed", 42}, {"case_hash", "h"}, {"realization", 3}, {"perturbation", nullptr}}}};
  for (const Measure& measure : measure_table)
    if (!measure.optional) result[measure.key] = 30.0;
  const auto read = [&] {
    write(directory / "result.json", result.dump());
    return read_result(directory / "result.json", realization(3), {.seed = 42, .case_hash = "h"});
  };
  const std::optional<Record> record = read();
  ASSERT_TRUE(record);
  EXPECT_TRUE(std::isnan(record->measures.front_at_thickness));
  EXPECT_EQ(record->front_thickness, 0.6);
  EXPECT_EQ(record->measures.front_mass_99, 30.0);
  result["front_at_thickness_m"] = 29.0;
  EXPECT_EQ(read()->measures.front_at_thickness, 29.0);
  result["front_mass_99_m"] = nullptr;
  EXPECT_FALSE(read()) << "a damaged document: this measure has every run";
}

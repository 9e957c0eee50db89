// Probabilities at targets, and their way through the tables.

#include <gtest/gtest.h>

#include <cmath>

#include "schema_check.hpp"
#include "statistics/histogram.hpp"
#include "studies.hpp"
#include "study/publish.hpp"
#include "study/target_summary.hpp"

namespace talus {
namespace {

using namespace fixtures;

TargetOutcome outcome(bool arrives, bool open, double depth) {
  TargetOutcome of{.of = {"house", TargetKind::structure}, .arrives = arrives, .open = open};
  if (arrives) of.arrival = 2.0 + depth;
  of.peak_depth = depth;
  of.peak_speed = 2.0 * depth;
  of.peak_horizontal_force = of.peak_downward_force = of.peak_overturning_moment = of.final_horizontal_force =
      of.horizontal_impulse = of.downward_impulse = 1000.0 * depth;
  return of;
}

/// Ten realizations: 4 reach the house with 1, 2, 3 and 4 m, the last of them open; 1 is undecided, 3 do not reach it,
/// 2 failed.
TargetSample sample() {
  return {.of = {"house", TargetKind::structure},
          .outcomes = {outcome(true, false, 1), outcome(true, false, 2), outcome(true, false, 3),
                       outcome(true, true, 4), outcome(false, true, 0), outcome(false, false, 0),
                       outcome(false, false, 0.1), outcome(false, false, 0)},
          .failed = 2};
}

TEST(TargetSummary, FailedAndUndecidedRunsCountInTheUpperBound) {
  const Proportion p = reached(sample());
  EXPECT_EQ(p.k, 4);
  EXPECT_EQ(p.n, 10);
  EXPECT_EQ(p.unknown, 1 + 2);
  EXPECT_DOUBLE_EQ(p.p, 0.4);
  EXPECT_EQ(p.lo, *wilson(4, 10).lo);
  EXPECT_EQ(p.hi, *wilson(7, 10).hi);
}

TEST(TargetSummary, OfANumberIsTheShareThatExceedsIt) {
  const TargetNumber& depth = *find_target_number("peak_depth_m");
  const auto k_and_unknown = [&](double x) {
    const Proportion p = beyond(sample(), depth, x);
    return std::pair(p.k, p.unknown);
  };
  EXPECT_EQ(k_and_unknown(0.05), std::pair(std::int64_t{5}, std::int64_t{3})) << "below the threshold counts too";
  EXPECT_EQ(k_and_unknown(2.0), std::pair(std::int64_t{2}, std::int64_t{3})) << "strictly";
  EXPECT_EQ(k_and_unknown(4.0), std::pair(std::int64_t{0}, std::int64_t{4})) << "an open run may have more";
  const Proportion by = beyond(sample(), *find_target_number("arrival_s"), 4.0);
  EXPECT_EQ(by.k, 2) << "the probability to arrive by x";
}

TEST(TargetSummary, OfNothingIsUnknown) {
  const Proportion p = reached({.of = {"house", TargetKind::point}, .outcomes = {}, .failed = 0});
  EXPECT_EQ(p.n, 0);
  EXPECT_EQ(p.lo, 0.0);
  EXPECT_EQ(p.hi, 1.0);
}

TEST(TargetSummary, SaysItInOneSentence) {
  EXPECT_EQ(exceedance_at(sample(), nullptr, 0.0)["sentence"],
            "P(house reached) = 0.40, 95 % 0.17 to 0.89, 4 of 10; 3 undecided (2 failed) count in the upper bound");
  EXPECT_EQ(exceedance_at(sample(), find_target_number("peak_depth_m"), 2.5)["sentence"],
            "P(house.peak_depth_m > 2.5 m) = 0.20, 95 % 0.06 to 0.76, 2 of 10; 3 undecided (2 failed) count in the "
            "upper bound");
  MeasureSample fronts{.values = {30, 40, 36, 34}, .failed = 0, .quality = {}};
  const Json answer = exceedance_at(*find_measure("front_mass_99_m"), fronts, 35);
  EXPECT_EQ(answer["sentence"], "P(front_mass_99_m > 35 m) = 0.50, 95 % 0.15 to 0.85, 2 of 4");
  EXPECT_EQ(answer["lo"], *wilson(2, 4).lo);
}

TEST(TargetSummary, FindsQuantitiesByTheirNames) {
  const std::vector<TargetName> targets{{"road", TargetKind::stretch}, {"house", TargetKind::structure}};
  EXPECT_EQ(find_quantity("front_mass_99_m", targets)->measure, find_measure("front_mass_99_m"));
  EXPECT_EQ(find_quantity("house", targets)->target, 1u);
  EXPECT_EQ(find_quantity("house.peak_horizontal_force_N_m", targets)->number,
            find_target_number("peak_horizontal_force_N_m"));
  EXPECT_FALSE(find_quantity("road.peak_horizontal_force_N_m", targets)) << "no structure has no load";
  EXPECT_FALSE(find_quantity("barn", targets));
  EXPECT_EQ(quantity_names(targets).size(), measure_table.size() + 5 + target_numbers.size());
}

TEST(TargetSummary, ARunFallsIntoTheLastClassThatItReaches) {
  const std::vector<HazardClass> classes{
      {.name = "low", .depth = 0.5}, {.name = "medium", .depth = 2.0, .speed = 3.0}, {.name = "high", .speed = 6.5}};
  EXPECT_EQ(hazard_class(outcome(true, false, 1), classes), 0u);
  EXPECT_EQ(hazard_class(outcome(true, false, 2), classes), 1u) << "speed 4 m/s";
  EXPECT_EQ(hazard_class(outcome(true, false, 4), classes), 2u) << "speed 8 m/s";
  EXPECT_FALSE(hazard_class(outcome(true, false, 0.4), classes));
  EXPECT_FALSE(hazard_class(outcome(false, false, 4), classes)) << "it did not arrive";
  const Json entry = target_json(sample(), classes);
  EXPECT_EQ(entry["hazard_classes"][0]["runs"], 1);
  EXPECT_EQ(entry["hazard_classes"][1]["runs"], 2);
  EXPECT_EQ(entry["hazard_classes"][0]["at_least"]["k"], 4);
  EXPECT_EQ(entry["hazard_classes"][2]["at_least"]["k"], 1);
  EXPECT_EQ(entry["hazard_classes"][2]["at_least"]["undecided"], 3) << "two failed, one undecided";
  EXPECT_FALSE(target_json(sample()).contains("hazard_classes"));
}

struct TargetTables : testing::Test {
  TemporaryDirectory directory;
  Plan plan_ = [] {
    Plan p = fixtures::plan(10);
    p.study.hazard_classes = {{.name = "low", .depth = 0.5}, {.name = "high", .depth = 2.0, .dynamic_pressure = 1e4}};
    p.targets = {{"house", TargetKind::structure}, {"road", TargetKind::stretch}};
    return p;
  }();
  std::vector<Record> runs() const {
    std::vector<Record> records;
    for (const TargetOutcome& of_house : sample().outcomes) {
      Record& record = records.emplace_back(done(static_cast<std::int64_t>(records.size()), 30.0));
      TargetOutcome road = of_house;
      road.of = {"road", TargetKind::stretch};
      record.targets = {of_house, road};
    }
    records.push_back(failed(8, "diverged"));
    records.push_back(failed(9, "diverged"));
    return records;
  }
};

TEST_F(TargetTables, ComeBackFromTheTables) {
  write_plan(directory.path(), plan_);
  write_tables({directory.path()}, plan_, runs(), {});
  const Tables tables = read_tables(directory.path());
  EXPECT_EQ(tables.plan.targets, plan_.targets);
  EXPECT_EQ(tables.plan.study.hazard_classes, plan_.study.hazard_classes);
  ASSERT_EQ(tables.runs.size(), 10u);
  const TargetSample written = sample();
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_EQ(tables.runs[i].targets.size(), 2u);
    const TargetOutcome &before = written.outcomes[i], &after = tables.runs[i].targets[0];
    EXPECT_EQ(after.of, before.of);
    EXPECT_EQ(after.arrives, before.arrives);
    EXPECT_EQ(after.open, before.open);
    EXPECT_EQ(std::isnan(after.arrival), std::isnan(before.arrival));
    for (const TargetNumber& number : target_numbers) {
      if (number.optional) continue;
      EXPECT_EQ(after.*number.member, before.*number.member) << number.key;
    }
  }
  EXPECT_TRUE(tables.runs[8].targets.empty());
  EXPECT_EQ(summary_of(tables.plan, tables.runs, {}).json().dump(), summary_of(plan_, runs(), {}).json().dump());
  const std::string head = content(directory / "realizations.csv").substr(0, 2000);
  EXPECT_NE(head.find(",front_thickness_m,house.arrives,house.open,house.arrival_s,"), std::string::npos);
  EXPECT_NE(head.find(",road.final_depth_m,checksum\n"), std::string::npos);
}

TEST_F(TargetTables, StandInTheSummaryThatTheSchemaDescribes) {
  const Json study = summary_of(plan_, runs(), {}).json();
  EXPECT_EQ(test::SchemaCheck("study").complaint(nlohmann::json::parse(study.dump())), "");
  ASSERT_EQ(study["targets"].size(), 2u);
  EXPECT_EQ(study["targets"][0]["reached"]["k"], 4);
  EXPECT_EQ(study["targets"][0]["numbers"]["peak_depth_m"]["mean"], 2.5);
  EXPECT_EQ(study["targets"][0]["numbers"]["peak_depth_m"]["exceedance"][0]["k"], 5);
  EXPECT_FALSE(study["targets"][1]["numbers"].contains("peak_horizontal_force_N_m"));
  EXPECT_FALSE(summary_of(fixtures::plan(3), {}, {}).json().contains("targets"));
}

TEST_F(TargetTables, RefuseAColumnOfATargetThatIsMissing) {
  write_plan(directory.path(), plan_);
  write_tables({directory.path()}, plan_, runs(), {});
  std::string text = content(directory / "realizations.csv");
  text.replace(text.find("house.peak_depth_m"), 18, "house.peak_width_m");
  write(directory / "realizations.csv", text);
  EXPECT_THROW(read_tables(directory.path()), IoError);
}

}  // namespace
}  // namespace talus

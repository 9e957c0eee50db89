#include <limits>

#include "schema_check.hpp"
#include "statistics/histogram.hpp"
#include "studies.hpp"
#include "study/summary.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

/// What schemas/study.schema.json has against `study`; "" when nothing.
std::string against_schema(const nlohmann::ordered_json& study) {
  static const talus::test::SchemaCheck schema("study");
  return schema.complaint(nlohmann::json::parse(study.dump()));
}

std::vector<Record> some_runs() {
  return {done(0, 34.0), done(1, 35.5), failed(2, "diverged"), done(3, 33.0), done(4, 36.25), done(6, 34.5)};
}

std::vector<Record> some_floor() { return {done(1, 34.01), done(2, 33.98), failed(3, "killed"), done(4, 34.02)}; }

}  // namespace

TEST(Summary, FollowsItsSchema) {
  Plan p = plan(8);
  p.study.noise_floor_replicates = 4;
  EXPECT_EQ(against_schema(summarize(p, some_runs(), some_floor())), "");
  EXPECT_EQ(against_schema(summarize(p, {}, {})), "");
  EXPECT_EQ(against_schema(summarize(p, {failed(0, "x")}, {})), "");
  EXPECT_EQ(against_schema(summarize(p, {done(0, 34.0)}, {})), "");
  EXPECT_EQ(against_schema(summarize(p, {done(0, 34.0), done(1, 34.0)}, {done(1, 34.0)})), "");
  p.study.stop_half_width = 0.5;
  p.study.histogram_edges = {30.0, 35.0, 40.0};
  p.study.sampling = Sampling::latin_hypercube;
  EXPECT_EQ(against_schema(summarize(p, some_runs(), some_floor())), "");
  nlohmann::ordered_json bad = summarize(p, some_runs(), some_floor());
  bad["quantities"]["influence_zone_m"].erase("stdev_ci95");
  EXPECT_NE(against_schema(bad), "");
}

TEST(Summary, CountsWhatWasPlannedMadeAndMissed) {
  const auto n = summarize(plan(9), some_runs(), {})["realizations"];
  EXPECT_EQ(n["planned"], 9);
  EXPECT_EQ(n["done"], 5);
  EXPECT_EQ(n["failed"], 1);
  EXPECT_EQ(n["complete"], false);
  EXPECT_EQ(n["missing"].dump(), "[[5,5],[7,8]]");
  const auto all = summarize(plan(2), {done(0, 1.0), failed(1, "x")}, {})["realizations"];
  EXPECT_EQ(all["complete"], true);
  EXPECT_EQ(all["missing"].dump(), "[]");
}

TEST(Summary, AMeasureWithoutAValueDoesNotCount) {  // a run that was recorded before the measure existed
  std::vector<Record> runs = some_runs();
  runs[1].measures.front_mass_999 = std::numeric_limits<double>::quiet_NaN();
  const auto study = summarize(plan(8), runs, {});
  EXPECT_EQ(study["quantities"]["front_mass_999_m"]["n"], 4);
  EXPECT_EQ(study["quantities"]["influence_zone_m"]["n"], 5);
  EXPECT_EQ(against_schema(study), "");
}

TEST(Summary, LeadsWithTheFrontOfTheMass) {
  const auto study = summarize(plan(8), some_runs(), {});
  EXPECT_EQ(study["leading_quantity"], "front_mass_99_m");
  EXPECT_EQ(study["quantities"].begin().key(), "front_mass_99_m");
  EXPECT_EQ(std::next(study["quantities"].begin()).key(), "influence_zone_m");
  EXPECT_EQ(study["quantities"].size(), measure_table.size());
  EXPECT_EQ(study["front_thickness_m"], 0.6);
  EXPECT_TRUE(summarize(plan(8), {}, {})["front_thickness_m"].is_null());
}

TEST(Summary, StatisticsOfEachMeasureAreThoseOfItsColumn) {
  const auto study = summarize(plan(8), some_runs(), {});
  for (const Measure& column : measure_table) {
    std::vector<double> sample;
    for (const Record& r : some_runs())
      if (r.done) sample.push_back(r.measures.*column.member);
    const SampleMoments m = moments(sample);
    const auto q = study["quantities"][column.key];
    EXPECT_EQ(q["n"], 5);
    EXPECT_EQ(q["mean"], *m.mean) << column.key;
    EXPECT_EQ(q["mean_ci95"][1], *m.mean_ci95->hi);
    EXPECT_EQ(q["stdev"], *m.stdev) << column.key;
    EXPECT_EQ(q["stdev_ci95"][0], *m.stdev_ci95->lo);
  }
}

TEST(Summary, FailuresStayInTheDenominatorOfEveryExceedance) {
  const auto curve = summarize(plan(8), some_runs(), {})["quantities"]["influence_zone_m"]["exceedance"];
  ASSERT_FALSE(curve.empty());
  for (const auto& e : curve) {
    EXPECT_EQ(e["n"], 6);
    EXPECT_DOUBLE_EQ(e["p"], e["k"].get<double>() / 6.0);
    EXPECT_EQ(e["p_if_failed_none_exceed"], e["p"]);
    EXPECT_DOUBLE_EQ(e["p_if_failed_all_exceed"], (e["k"].get<double>() + 1.0) / 6.0);
  }
  EXPECT_EQ(curve.back()["k"], 0);
  EXPECT_LE(curve.front()["x"], 33.0);
}

TEST(Summary, NoiseFloorIncludesTheRealizationItReplicates) {
  const auto study = summarize(plan(8), some_runs(), some_floor());
  const auto q = study["quantities"]["influence_zone_m"];
  const SampleMoments noise =
      moments(std::vector{34.0, 34.01, 33.98, 34.02});  // realization 0 first, the failed one left out
  EXPECT_EQ(q["noise_floor_stdev"], *noise.stdev);
  EXPECT_EQ(q["noise_floor_stdev_ci95"][0], *noise.stdev_ci95->lo);
  EXPECT_DOUBLE_EQ(q["stdev_over_noise_floor"], q["stdev"].get<double>() / *noise.stdev);
  EXPECT_EQ(study["noise_floor"]["replicates_done"], 3);
  EXPECT_EQ(study["noise_floor"]["replicates_failed"], 1);
  EXPECT_TRUE(summarize(plan(8), some_runs(), {})["quantities"]["influence_zone_m"]["noise_floor_stdev"].is_null());
}

TEST(Summary, GivenEdgesAreUsedForFrontsOnly) {
  Plan p = plan(8);
  p.study.histogram_edges = {33.5, 34.5, 36.0};
  const auto q = summarize(p, some_runs(), {})["quantities"];
  const auto h = q["influence_zone_m"]["histogram"];
  EXPECT_EQ(h["edges"].dump(), "[33.5,34.5,36.0]");
  EXPECT_EQ(h["counts"].dump(), "[1,2]");  // 34.0 | 34.5, 35.5
  EXPECT_EQ(h["underflow"], 1);
  EXPECT_EQ(h["overflow"], 1);
  EXPECT_EQ(h["convention"], histogram_convention);
  EXPECT_EQ(h["edges_given"], true);
  EXPECT_EQ(q["centre_of_mass_x_m"]["histogram"]["edges_given"], false);
  EXPECT_EQ(q["centre_of_mass_x_m"]["histogram"]["underflow"], 0);
}

TEST(Summary, NamesFailuresExtremesAndFriction) {
  const auto study = summarize(plan(8), some_runs(), {});
  EXPECT_EQ(study["failures"].dump(), R"([{"index":2,"reason":"diverged"}])");
  EXPECT_EQ(study["extremes"]["farthest_realization"], 4);
  EXPECT_EQ(study["extremes"]["shortest_realization"], 3);
  EXPECT_DOUBLE_EQ(study["mean_friction_angle_deg"]["mean"], 25.0 - 0.1 * (0 + 1 + 3 + 4 + 6) / 5.0);
  EXPECT_EQ(study["captured_variance"], 0.25);
  EXPECT_EQ(study["effort"]["steps"], 5 * 1000 + 0 + 1 + 3 + 4 + 6);
}

TEST(Summary, SaysWhatALatinHypercubeMeansForIntervals) {
  Plan p = plan(8);
  EXPECT_FALSE(summarize(p, some_runs(), {})["notes"].contains("sampling"));
  p.study.sampling = Sampling::latin_hypercube;
  const auto study = summarize(p, some_runs(), {});
  EXPECT_NE(study["notes"]["sampling"].get<std::string>().find("conservative"), std::string::npos);
  EXPECT_EQ(study["provenance"]["sampling"], "latin_hypercube");
}

TEST(Summary, MeasuresOfSoilThatLeftTheTerrainAreLowerBounds) {
  // The bed ends at 31 m. Soil of runs 6 to 9 left, of run 9 more than 1 % of it.
  std::vector<Record> runs;
  for (std::int64_t k = 0; k < 10; ++k) {
    Record run{.index = k, .done = true};
    run.measures.influence_zone = k < 6 ? 20.0 + static_cast<double>(k) : 31.0;
    run.measures.front_mass_99 = k < 9 ? 19.0 + static_cast<double>(k) : 31.0;
    run.measures.centre_of_mass_x = 12.0 + static_cast<double>(k);
    if (k >= 6) run.lower_bounds = "influence_zone_m front_mass_999_m centre_of_mass_x_m";
    if (k == 9) run.lower_bounds += " front_mass_99_m";
    runs.push_back(run);
  }
  Plan plan;
  plan.study.realizations = 10;
  const Json quantities = summary_of(plan, runs, {}).json()["quantities"];
  const Json q = quantities["influence_zone_m"];
  EXPECT_EQ(q["censored"], (Json{{"runs", 4}, {"from", 31.0}}));
  EXPECT_EQ(q["mean_at_least"], true);
  EXPECT_TRUE(q["mean_ci95"].is_null());
  for (const Json& quantile : q["quantiles"]) EXPECT_EQ(quantile["at_least"], quantile["p"] >= 0.75) << quantile;
  EXPECT_EQ(q["exceedance"].back()["p"], 0.4) << "at the bed's end and beyond";
  EXPECT_EQ(quantities["front_mass_99_m"]["censored"], (Json{{"runs", 1}, {"from", 31.0}}));
  EXPECT_EQ(quantities["front_mass_99_m"]["exceedance"].back()["p"], 0.1);
  EXPECT_EQ(quantities["front_mass_99_m"]["mean_at_least"], true);
  EXPECT_EQ(quantities["centre_of_mass_x_m"]["censored"], (Json{{"runs", 4}, {"from", 18.0}}));
  EXPECT_TRUE(quantities["front_connected_m"]["censored"].is_null());
  for (Record& run : runs) run.lower_bounds.clear();
  const Json known = summary_of(plan, runs, {}).json()["quantities"]["influence_zone_m"];
  EXPECT_EQ(known["mean_at_least"], false);
  EXPECT_TRUE(known["censored"].is_null());
  EXPECT_EQ(known["exceedance"].back()["p"], 0.0);
}

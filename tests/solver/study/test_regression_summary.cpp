// The mean of a study by regression on its draws: which numbers serve, what is said where none does, and what the
// summary has.
#include <gtest/gtest.h>

#include <cmath>

#include "schema_check.hpp"
#include "statistics/stream.hpp"
#include "studies.hpp"
#include "study/regression_summary.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

Plan random_plan(std::int64_t realizations) {
  Plan p = plan(realizations);
  p.draws = {{"friction", 0, 100}, {"viscosity", 3, 1}};
  return p;
}

/// The farthest particle goes 30 m, 2 m more with each standard deviation of the field's first coefficient, 1 m less
/// with each of the viscosity, and a little for a reason that is not drawn.
double front(const Plan& p, std::int64_t index) {
  const auto i = static_cast<std::uint64_t>(index);
  return 30.0 + 2.0 * standard_normal(p.seed, i, 0, 0) - standard_normal(p.seed, i, 0, 3) +
         0.2 * standard_normal(p.seed, i, 7, 9);
}

std::vector<Record> runs(const Plan& p, std::int64_t n) {
  std::vector<Record> all;
  for (std::int64_t i = 0; i < n; ++i) all.push_back(i == 4 ? failed(i, "diverged") : done(i, front(p, i)));
  return all;
}

Json regression(const Plan& p, const std::vector<Record>& of) {
  return summarize(p, of, {})["quantities"]["influence_zone_m"]["regression"];
}

std::string none_because(const Plan& p, const std::vector<Record>& of) {
  return regression(p, of).value("none_because", "");
}

TEST(Regression, TakesTheLeadingNumberOfEachPropertyFirst) {
  const auto numbers = possible_regressors({{"friction", 0, 3}, {"viscosity", 3, 1}, {"cohesion", 1, 0}}, 1000);
  ASSERT_EQ(numbers.size(), 4U);
  const std::size_t blocks[] = {0, 1, 0, 0};
  const std::uint32_t modes[] = {0, 0, 1, 2};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(numbers[k].block, blocks[k]);
    EXPECT_EQ(numbers[k].mode, modes[k]);
  }
  EXPECT_EQ(possible_regressors({{"friction", 0, 1000}}, 14).size(), 2U);  // five runs each
  EXPECT_EQ(possible_regressors({{"friction", 0, 1000}}, 1000).size(), most_regressors);
  EXPECT_EQ(possible_regressors({{"friction", 0, 1000}}, 1'000'000).size(), 4U);
}

TEST(Regression, FindsTheMeanAndWhatMovesIt) {
  const Plan p = random_plan(60);
  const Json found = regression(p, runs(p, 60));
  const double error = 0.2 / std::sqrt(59);  // of the mean
  EXPECT_NEAR(found.at("mean").get<double>(), 30.0, 3 * error);
  EXPECT_GT(found.at("worth_runs").get<double>(), 59 * 40.0);  // 5.04 / 0.04 of the variance, less 2 in 3
  EXPECT_EQ(found.at("slopes")[0].at("name"), "friction 1");
  EXPECT_EQ(found.at("slopes")[1].at("name"), "viscosity");
  EXPECT_NEAR(found.at("slopes")[0].at("per_stdev").get<double>(), 2.0, 5 * error);
  EXPECT_NEAR(found.at("slopes")[1].at("per_stdev").get<double>(), -1.0, 5 * error);
  EXPECT_NEAR(found.at("shares")[0].at("share").get<double>(), 4 / 5.04, 0.05);
  EXPECT_NEAR(found.at("shares")[1].at("share").get<double>(), 1 / 5.04, 0.05);
}

TEST(Regression, SaysWhyThereIsNone) {
  const Plan p = random_plan(60);
  EXPECT_NE(none_because(p, runs(p, 10)).find("fewer than 10 runs"), std::string::npos);  // one of them failed
  EXPECT_EQ(none_because(p, runs(p, 11)), "");
  EXPECT_NE(none_because(plan(60), runs(p, 60)).find("plan"), std::string::npos);
  Plan other = p;
  other.study.sampling = Sampling::latin_hypercube;
  EXPECT_NE(none_because(other, runs(p, 60)).find("Latin hypercube"), std::string::npos);
  other = p;
  other.draws = {{"friction", 0, 0}};
  EXPECT_NE(none_because(other, runs(p, 60)).find("circulant embedding"), std::string::npos);
  std::vector<Record> censored = runs(p, 60);
  censored[7].lower_bounds = "influence_zone_m";
  EXPECT_NE(none_because(p, censored).find("lower bound"), std::string::npos);
  std::vector<Record> same = runs(p, 60);
  for (Record& run : same) run.measures.influence_zone = 30.0;
  EXPECT_NE(none_because(p, same).find("explains nothing"), std::string::npos);
}

TEST(Regression, FollowsTheSchema) {
  static const test::SchemaCheck schema("study");
  const Plan p = random_plan(60);
  for (const std::int64_t n : {0, 5, 60}) {
    const Json study = summarize(p, runs(p, n), {});
    EXPECT_EQ(schema.complaint(nlohmann::json::parse(study.dump())), "") << n;
  }
  Json bad = summarize(p, runs(p, 60), {});
  bad["quantities"]["influence_zone_m"]["regression"].erase("mean_ci95");
  EXPECT_NE(schema.complaint(nlohmann::json::parse(bad.dump())), "");
}

TEST(Regression, ThePlanKeepsWhatIsDrawn) {
  const TemporaryDirectory scratch;
  const Plan p = random_plan(60);
  write_plan(scratch.path(), p);
  EXPECT_EQ(find_plan(scratch.path())->draws, p.draws);
}

}  // namespace

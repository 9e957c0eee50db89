// Paired comparisons against closed forms and simulated draws.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "statistics/paired.hpp"
#include "statistics/proportion.hpp"

namespace talus {
namespace {

TEST(PairedDifference, IsStudentsForTheDifferences) {
  const std::vector<double> a{1, 2, 3, 4}, b{2, 2, 5, 5};  // differences 1, 0, 2, 1: mean 1, s^2 = 2/3
  const PairedDifference d = paired_difference(a, b);
  EXPECT_EQ(d.n, 4);
  EXPECT_DOUBLE_EQ(*d.mean, 1.0);
  EXPECT_NEAR(*d.stdev, std::sqrt(2.0 / 3.0), 1e-12);
  const double t = 3.182446305284263;  // t_{0.975, 3}
  EXPECT_NEAR(*d.ci95->hi, 1.0 + t * std::sqrt(2.0 / 3.0) / 2.0, 1e-9);
  EXPECT_NEAR(*d.worth_runs, 4.0 * (5.0 / 3.0 + 3.0) / (2.0 / 3.0), 1e-9);
}

TEST(PairedDifference, OfOnePairHasNoInterval) {
  const std::vector<double> a{1}, b{3};
  const PairedDifference d = paired_difference(a, b);
  EXPECT_EQ(d.mean, 2.0);
  EXPECT_FALSE(d.ci95);
  EXPECT_FALSE(d.worth_runs);
  EXPECT_FALSE(paired_difference({}, {}).mean);
}

TEST(ClopperPearson, IsExactAtTheEnds) {
  const Interval none = clopper_pearson(0, 20), all = clopper_pearson(20, 20);
  EXPECT_EQ(none.lo, 0.0);
  EXPECT_NEAR(*none.hi, 1.0 - std::pow(0.025, 1.0 / 20), 1e-12);
  EXPECT_EQ(all.hi, 1.0);
  EXPECT_NEAR(*all.lo, std::pow(0.025, 1.0 / 20), 1e-12);
}

TEST(PairedHits, CountAndTest) {
  std::vector<std::pair<bool, bool>> pairs(7, {true, true});
  pairs.insert(pairs.end(), 6, {true, false});
  pairs.insert(pairs.end(), 1, {false, true});
  pairs.insert(pairs.end(), 6, {false, false});
  const PairedHits hits = paired_hits(pairs);
  EXPECT_EQ(hits.n, 20);
  EXPECT_EQ(hits.both, 7);
  EXPECT_EQ(hits.only_a, 6);
  EXPECT_EQ(hits.only_b, 1);
  EXPECT_DOUBLE_EQ(hits.difference, -0.25);
  EXPECT_NEAR(hits.p_value, 2.0 * (1 + 7) / 128.0, 1e-12);
  EXPECT_LT(*hits.ci95.lo, -0.25);
  EXPECT_GT(*hits.ci95.hi, -0.25);
}

TEST(PairedHits, WithoutDiscordanceDecideNothing) {
  const std::vector<std::pair<bool, bool>> pairs(20, {true, true});
  const PairedHits hits = paired_hits(pairs);
  EXPECT_EQ(hits.p_value, 1.0);
  EXPECT_EQ(hits.difference, 0.0);
  EXPECT_NEAR(*hits.ci95.hi, 1.0 - std::pow(0.0125, 1.0 / 20), 1e-12);
  EXPECT_NEAR(*hits.ci95.lo, -*hits.ci95.hi, 1e-12);
  EXPECT_EQ(paired_hits({}).ci95, (Interval{-1.0, 1.0}));
}

/// 2,000 studies of 40 pairs with P_A = 0.5 and P_B = 0.3, as likely to hit together as one draw makes them. The share
/// of intervals that hold -0.2 is at least 95 %: allowed down to z = 3 below, 0.95 - 3 sqrt(0.95 0.05/2000) = 0.935.
TEST(PairedHits, IntervalsCoverTheDifference) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int covered = 0;
  for (int study = 0; study < 2000; ++study) {
    std::vector<std::pair<bool, bool>> pairs;
    for (int i = 0; i < 40; ++i) {
      const double draw = 0.7 * u(random), a = draw + 0.3 * u(random), b = draw + 0.3 * u(random);
      // P(draw + 0.3 u < q) of a trapezium: q_50 = 0.5, q_30 by (q - 0.15)/0.7 = 0.3
      pairs.emplace_back(a < 0.5, b < 0.36);
    }
    const PairedHits hits = paired_hits(pairs);
    covered += *hits.ci95.lo <= -0.2 && *hits.ci95.hi >= -0.2 ? 1 : 0;
  }
  EXPECT_GT(covered, 0.935 * 2000);
  EXPECT_LT(covered, 2000) << "never narrow enough to miss: the interval says nothing";
}

TEST(Proportion, UnknownTrialsWidenTheUpperBoundOnly) {
  const Proportion p = proportion(3, 10, 0), q = proportion(3, 10, 2);
  EXPECT_EQ(q.lo, p.lo);
  EXPECT_EQ(q.p, p.p);
  EXPECT_GT(q.hi, p.hi);
  EXPECT_EQ(proportion(0, 10, 0).lo, 0.0);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>

#include "statistics/histogram.hpp"

using namespace talus;

namespace {

const std::vector<double> x{34.1, 33.2, 35.7, 34.4, 36.9, 33.8, 34.05, 35.2, 34.6, 38.3, 33.9, 34.9};

std::vector<double> sorted(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v;
}

}  // namespace

TEST(Histogram, BinsAreClosedOnTheLeftAndTheLastOnBothSides) {
  const Histogram h = histogram(std::vector{0.0, 0.999, 1.0, 1.5, 2.0, 3.0, -1e-12, 3.0 + 1e-12}, {0.0, 1.0, 2.0, 3.0});
  EXPECT_EQ(h.counts, (std::vector<std::int64_t>{2, 2, 2}));
  EXPECT_EQ(h.underflow, 1);
  EXPECT_EQ(h.overflow, 1);
}

TEST(Histogram, UnequalBins) {  // numpy.histogram(x, [33, 34, 34.5, 37, 39])
  const Histogram h = histogram(x, {33.0, 34.0, 34.5, 37.0, 39.0});
  EXPECT_EQ(h.counts, (std::vector<std::int64_t>{3, 3, 5, 1}));
  EXPECT_EQ(h.underflow + h.overflow, 0);
}

TEST(RoundEdges, HoldTheSampleAtRoundNumbers) {
  // Scott: 3.49 * 1.4487 / 12^(1/3) = 2.208, so the step is 2.
  EXPECT_EQ(round_edges(x), (std::vector{32.0, 34.0, 36.0, 38.0, 40.0}));
  EXPECT_EQ(round_grid(-0.35, 0.3, 0.1), (std::vector{-0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(round_grid(7.0, 7.0, 3.0), (std::vector{6.0, 8.0}));
  EXPECT_EQ(round_grid(120.0, 260.0, 70.0), (std::vector{100.0, 150.0, 200.0, 250.0, 300.0}));
}

TEST(RoundEdges, OddSamples) {
  EXPECT_TRUE(round_edges({}).empty());
  EXPECT_EQ(round_edges(std::vector{34.1, 34.1}).size(), 2u);
  EXPECT_EQ(round_edges(std::vector{34.13}), (std::vector{34.1, 34.2}));
  EXPECT_EQ(round_edges(std::vector{0.0, 0.0}), (std::vector{0.0, 0.1}));
  std::vector<double> outlier(1000, 1.0);  // a narrow body and one far away must not make a million bins
  for (std::size_t i = 0; i < outlier.size(); ++i) outlier[i] += 1e-6 * static_cast<double>(i);
  outlier.push_back(1e6);
  EXPECT_LE(round_edges(outlier).size(), 1003u);
}

TEST(RoundEdges, EverySampleFallsInside) {
  for (double scale : {1e-4, 0.03, 1.0, 77.0, 1e6}) {
    for (double shift : {-3.0, 0.0, 0.1, 1.0}) {
      std::vector<double> sample = x;
      for (double& v : sample) v = (v - 34.0 + shift) * scale;
      const Histogram h = histogram(sample, round_edges(sample));
      EXPECT_EQ(std::accumulate(h.counts.begin(), h.counts.end(), std::int64_t{0}), 12) << scale << " " << shift;
      EXPECT_GT(h.counts.front(), 0) << scale << " " << shift;
    }
  }
}

TEST(Wilson, AgainstSciPy) {  // scipy 1.17.1: stats.binomtest(k, n).proportion_ci(.95, 'wilson')
  const struct {
    std::int64_t k, n;
    double lo, hi;
  } cases[] = {{0, 12, 0.0, 0.24249400665524085},
               {3, 12, 0.08894166839405471, 0.5323053349335657},
               {12, 12, 0.7575059933447592, 1.0},
               {17, 1000, 0.01064068985681633, 0.027055958840229925},
               {500, 1000, 0.4690696003681042, 0.5309303996318958}};
  for (const auto& c : cases) {
    EXPECT_NEAR(*wilson(c.k, c.n).lo, c.lo, 1e-14);
    EXPECT_NEAR(*wilson(c.k, c.n).hi, c.hi, 1e-14);
  }
  EXPECT_EQ(*wilson(0, 12).lo, 0.0);
  EXPECT_EQ(*wilson(12, 12).hi, 1.0);
}

TEST(ExceedanceCurve, CountsStrictlyAbove) {
  const auto curve = exceedance(sorted(x), std::vector{33.0, 34.1, 38.3}, 0);
  ASSERT_EQ(curve.size(), 3u);
  EXPECT_EQ(curve[0].k, 12);
  EXPECT_EQ(curve[1].k, 7);  // 34.1 does not exceed itself
  EXPECT_EQ(curve[2].k, 0);
  EXPECT_EQ(curve[1].n, 12);
  EXPECT_DOUBLE_EQ(curve[1].p, 7.0 / 12.0);
  EXPECT_EQ(curve[1].lo, *wilson(7, 12).lo);
  EXPECT_EQ(curve[1].hi, *wilson(7, 12).hi);
}

TEST(ExceedanceCurve, FailuresStayInTheDenominatorAndWidenTheBounds) {
  const Exceedance e = exceedance(sorted(x), std::vector{34.1}, 3).front();
  EXPECT_EQ(e.k, 7);
  EXPECT_EQ(e.n, 12 + 3);
  EXPECT_DOUBLE_EQ(e.p, 7.0 / 15.0);
  EXPECT_DOUBLE_EQ(e.p_if_failed_all_exceed, (7.0 + 3.0) / 15.0);
  EXPECT_EQ(e.lo, *wilson(7, 15).lo);
  EXPECT_EQ(e.hi, *wilson(10, 15).hi);
  EXPECT_TRUE(exceedance({}, std::vector{1.0}, 0).empty());
  EXPECT_EQ(exceedance({}, std::vector{1.0}, 2).front().p_if_failed_all_exceed, 1.0);
}

TEST(RoundGrid, EndsWhateverTheValues) {
  std::mt19937 random(1);
  const auto any = [&] {  // any magnitude from a denormal number to 1e100
    const double magnitude = std::pow(10.0, std::uniform_real_distribution(-323.0, 100.0)(random));
    return random() % 8 == 0 ? 0.0 : random() % 2 == 0 ? magnitude : -magnitude;
  };
  for (int i = 0; i < 20'000; ++i) {
    const auto [lo, hi] = std::minmax({any(), any()});
    const double width = std::max(std::abs(any()), 1e-300);
    const std::vector<double> grid = round_grid(lo, hi, width);
    ASSERT_LE(grid.size(), 1003u) << lo << " " << hi << " " << width;
    ASSERT_LE(grid.front(), lo);
    ASSERT_GE(grid.back(), hi);
    ASSERT_TRUE(std::ranges::is_sorted(grid));
    const std::vector<double> sample{lo, hi};
    ASSERT_LE(round_edges(sample).size(), 1003u);
  }
}

TEST(EqualEdges, SpanTheSampleExactly) {
  const std::vector<double> edges = equal_edges(sorted(x), 3);
  ASSERT_EQ(edges.size(), 4u);
  EXPECT_EQ(edges.front(), 33.2);
  EXPECT_EQ(edges.back(), 38.3);
  EXPECT_DOUBLE_EQ(edges[1], 33.2 + (38.3 - 33.2) / 3);
  EXPECT_EQ(histogram(x, edges).overflow + histogram(x, edges).underflow, 0);
}

TEST(EqualEdges, OddSamples) {
  EXPECT_TRUE(equal_edges({}, 5).empty());
  const Histogram h = histogram(std::vector{34.0, 34.0}, equal_edges(std::vector{34.0, 34.0}, 2));
  EXPECT_EQ(h.counts[0] + h.counts[1], 2);
}

TEST(Exceedance, CensoredValuesCountAsBeyondEveryX) {
  const std::vector<double> sorted{28, 30, 31, 31}, censored{31, 31}, x{29, 31, 50};
  const std::vector<Exceedance> curve = exceedance(sorted, x, 1, censored);
  EXPECT_EQ(curve[0].k, 3);  // seen to exceed 29
  EXPECT_EQ(curve[1].k, 2);
  EXPECT_DOUBLE_EQ(curve[2].p, 2.0 / 5.0);
  EXPECT_EQ(curve[2].lo, *wilson(0, 5).lo);
  EXPECT_EQ(curve[2].hi, *wilson(2 + 1, 5).hi);
}

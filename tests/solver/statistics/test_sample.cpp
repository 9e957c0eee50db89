// References: SciPy 1.17.1. Each test names the call that gave its constants; `x`, `b`, `f` are the samples below as
// NumPy arrays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "statistics/sample.hpp"

using namespace talus;

namespace {

const std::vector<double> x{34.1, 33.2, 35.7, 34.4, 36.9, 33.8, 34.05, 35.2, 34.6, 38.3, 33.9, 34.9};
const std::vector<double> b{26., 27.1, 24.2, 25.4, 23.1, 26.5, 25.9, 24.4, 25.0, 22.2, 26.1, 25.3};
const std::vector<double> f{34.1, 34.15, 34.05, 34.12, 34.3};

std::vector<double> sorted(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v;
}

}  // namespace

TEST(Moments, MeanAndStudentInterval) {  // x.mean(), stats.t.interval(.95, 11, x.mean(), x.std(ddof=1)/sqrt(12))
  const SampleMoments m = moments(x);
  EXPECT_EQ(m.n, 12);
  EXPECT_NEAR(*m.mean, 34.920833333333334, 1e-13);
  EXPECT_NEAR(*m.mean_ci95->lo, 34.000348486377824, 1e-12);
  EXPECT_NEAR(*m.mean_ci95->hi, 35.841318180288845, 1e-12);
  EXPECT_EQ(*m.min, 33.2);
  EXPECT_EQ(*m.max, 38.3);
}

TEST(Moments, StdevAndChiSquareInterval) {  // x.std(ddof=1), s*sqrt(11/stats.chi2.ppf([.975, .025], 11))
  const SampleMoments m = moments(x);
  EXPECT_NEAR(*m.stdev, 1.4487390023636746, 1e-13);
  EXPECT_NEAR(*m.stdev_ci95->lo, 1.026279684139464, 1e-12);
  EXPECT_NEAR(*m.stdev_ci95->hi, 2.45978210553269, 1e-12);
}

TEST(Moments, SkewnessAndExcessKurtosis) {  // stats.skew(x), stats.kurtosis(x)
  const SampleMoments m = moments(x);
  EXPECT_NEAR(*m.skewness, 1.182812781166423, 1e-12);
  EXPECT_NEAR(*m.excess_kurtosis, 0.5717727544006159, 1e-12);
}

TEST(Moments, WhatCannotBeSaidIsUnset) {
  EXPECT_FALSE(moments({}).mean);
  const SampleMoments one = moments(std::vector{3.5});
  EXPECT_EQ(*one.mean, 3.5);
  EXPECT_FALSE(one.mean_ci95 || one.stdev || one.stdev_ci95 || one.skewness);
  EXPECT_FALSE(moments(std::vector{1.0, 2.0}).skewness);
}

TEST(Moments, AConstantSampleDoesNotVary) {
  const SampleMoments m = moments(std::vector<double>(7, 0.1));  // 0.1 + ... seven times is not 0.7
  EXPECT_EQ(*m.mean, 0.1);
  EXPECT_EQ(*m.stdev, 0.0);
  EXPECT_EQ(m.mean_ci95, (Interval{0.1, 0.1}));
  EXPECT_FALSE(m.skewness);
}

TEST(Moments, FarFromZeroStaysExact) {  // shifting by 2^30 (exact in binary for quarters) must not change the spread
  const std::vector<double> near{0.25, 0.75, 1.5, 2.25};
  std::vector<double> far = near;
  for (double& v : far) v += 1073741824.0;
  EXPECT_DOUBLE_EQ(*moments(far).stdev, *moments(near).stdev);
}

TEST(Quantile, Type7) {  // numpy.quantile(x, p)
  const std::vector<double> s = sorted(x);
  EXPECT_NEAR(quantile(s, 0.05).value, 33.53, 1e-12);
  EXPECT_NEAR(quantile(s, 0.25).value, 34.0125, 1e-12);
  EXPECT_NEAR(quantile(s, 0.5).value, 34.5, 1e-12);
  EXPECT_NEAR(quantile(s, 0.9).value, 36.78, 1e-12);
  EXPECT_NEAR(quantile(s, 0.95).value, 37.53, 1e-12);
  EXPECT_EQ(quantile(s, 0.0).value, 33.2);
  EXPECT_EQ(quantile(s, 1.0).value, 38.3);
  EXPECT_EQ(quantile(std::vector{4.0}, 0.3).value, 4.0);
}

TEST(Quantile, RanksOfTheInterval) {
  // B = stats.binom(n, p); l = max(k for k in range(n+2) if B.cdf(k-1) <= .025); u = min(k for k in range(n+2) if
  // B.sf(k-1) <= .025)
  const struct {
    std::int64_t n;
    double p;
    std::int64_t l, u;
  } cases[] = {{12, .5, 3, 10},      {12, .05, 0, 3},       {12, .25, 0, 7}, {100, .95, 90, 100},
               {1000, .5, 469, 532}, {1000, .99, 983, 997}, {5, .5, 0, 6}};
  for (const auto& c : cases) {
    const Ranks r = quantile_ranks(c.n, c.p);
    EXPECT_EQ(r.l, c.l) << c.n << " " << c.p;
    EXPECT_EQ(r.u, c.u) << c.n << " " << c.p;
  }
}

TEST(Quantile, IntervalLiesBetweenOrderStatistics) {
  const std::vector<double> s = sorted(x);
  EXPECT_EQ(quantile(s, 0.5).ci95, (Interval{s[3 - 1], s[10 - 1]}));
  EXPECT_EQ(quantile(s, 0.05).ci95, (Interval{std::nullopt, s[3 - 1]}));
  EXPECT_EQ(quantile(std::vector{1.0, 2.0, 3.0}, 0.5).ci95, Interval{});
}

TEST(Quantile, FailuresShiftItBothWays) {
  // numpy.quantile(concatenate([x, [1e9]*2]), p) and numpy.quantile(concatenate([[-1e9]*2, x]), p)
  const std::vector<double> s = sorted(x);
  EXPECT_NEAR(*quantile(s, 0.25, 2).if_failed_above, 34.0625, 1e-12);
  EXPECT_NEAR(*quantile(s, 0.25, 2).if_failed_below, 33.825, 1e-12);
  EXPECT_NEAR(*quantile(s, 0.5, 2).if_failed_above, 34.75, 1e-12);
  EXPECT_NEAR(*quantile(s, 0.5, 2).if_failed_below, 34.25, 1e-12);
  EXPECT_FALSE(quantile(s, 0.95, 2).if_failed_above);  // 13 of 14 lie below 0.95: among the failed
  EXPECT_FALSE(quantile(s, 0.05, 2).if_failed_below);
  EXPECT_EQ(*quantile(s, 0.5, 0).if_failed_above, quantile(s, 0.5).value);
}

TEST(Intervals, CoverAsOftenAsTheySay) {
  // 4000 samples of 20 normal draws. A true 95 % interval misses 200 +/- 13.8; the bound is 4 standard deviations.
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(10.0, 2.0);
  int mean_missed = 0, stdev_missed = 0, median_missed = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<double> sample(20);
    for (double& v : sample) v = normal(random);
    const SampleMoments m = moments(sample);
    mean_missed += *m.mean_ci95->lo > 10.0 || *m.mean_ci95->hi < 10.0;
    stdev_missed += *m.stdev_ci95->lo > 2.0 || *m.stdev_ci95->hi < 2.0;
    const Interval median = quantile(sorted(sample), 0.5).ci95;
    median_missed += *median.lo > 10.0 || *median.hi < 10.0;
  }
  const double bound = 4.0 * std::sqrt(4000 * 0.05 * 0.95);
  EXPECT_NEAR(mean_missed, 200, bound);
  EXPECT_NEAR(stdev_missed, 200, bound);
  // stats.binom(20, .5): P(6 <= B <= 14) = 0.9586, so 165.6 are missed.
  EXPECT_NEAR(median_missed, 4000 * (1 - 0.958610534667969), bound);
}

TEST(StdevRatio, FisherInterval) {  // r = x.std(ddof=1)/f.std(ddof=1); r/sqrt(stats.f.ppf([.975, .025], 11, 4))
  const Ratio r = *stdev_ratio(moments(x), moments(f));
  EXPECT_NEAR(r.value, 15.330786045747407, 1e-10);
  EXPECT_NEAR(*r.ci95.lo, 5.169906196757784, 1e-10);
  EXPECT_NEAR(*r.ci95.hi, 31.69831077263276, 1e-10);
  EXPECT_FALSE(stdev_ratio(moments(x), moments(std::vector{1.0, 1.0})));
  EXPECT_FALSE(stdev_ratio(moments(x), moments({})));
}

TEST(Correlation, Pearson) {  // stats.pearsonr(x, b)
  EXPECT_NEAR(*correlation(x, b), -0.9814788391203272, 1e-12);
  EXPECT_FALSE(correlation(x, std::vector<double>(12, 1.0)));
  EXPECT_FALSE(correlation({}, {}));
}

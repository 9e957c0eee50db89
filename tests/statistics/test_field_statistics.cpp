// Samples of random fields and of random numbers against the laws they are meant to follow. Seeds are fixed, so a test
// passes always or never; the stated levels say how likely a right program would have been to fail when it was written.

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdint>
#include <functional>

#include "covariance_sample.hpp"
#include "random_field/random_field.hpp"
#include "random_field/stream.hpp"

namespace talus {
namespace {

constexpr Box slide{{0.0, 2.0}, {6.0, 5.0}};
using test::z_bound;
constexpr double p_bound = 1e-5;  // of chi-square tests, either tail

void expect_covariance(const RandomField& field, const std::vector<Vec2>& points,
                       const std::function<double(Vec2, Vec2)>& expected) {
  test::expect_moments(field, points, std::vector<double>(points.size()),
                       [&](std::size_t i, std::size_t j) { return expected(points[i], points[j]); });
}

const std::vector<Vec2> points{{0.5, 2.5}, {0.75, 2.5},  {0.5, 2.75}, {1.0, 3.0}, {3.0, 3.5}, {3.25, 3.25},
                               {5.5, 4.5}, {5.75, 4.75}, {6.0, 5.0},  {0.0, 2.0}, {3.0, 2.0}, {2.0, 5.0}};

TEST(FieldStatistics, CovarianceOfCirculantEmbedding) {
  const std::vector<Vec2> nodes{{0, 2}, {0.5, 2}, {0.5, 2.5}, {1, 3}, {3, 3.5}, {3, 4}, {5.5, 4.5}, {6, 5}};
  const FieldSpec spec{.ell_x = 1.5, .ell_y = 0.5, .sampler = FieldSampler::circulant_embedding, .grid_spacing = 0.5};
  expect_covariance(RandomField(spec, slide, 0.25), nodes,
                    [](Vec2 p, Vec2 q) { return std::exp(-std::abs(p.x - q.x) / 1.5 - std::abs(p.y - q.y) / 0.5); });
}

/// Covariance that the modes kept have, by Mercer's sum over eigenfunctions.
TEST(FieldStatistics, CovarianceOfTruncatedKarhunenLoeve) {
  const FieldSpec spec{.ell_x = 1.5, .ell_y = 0.5, .terms = 200};
  const RandomField field(spec, slide, 0.1);
  std::vector<std::vector<double>> columns;
  for (std::size_t k = 0; k < field.terms(); ++k) {
    std::vector<double> xi(field.terms(), 0.0);
    xi[k] = 1;
    columns.push_back(field.gaussian(points, xi));
  }
  expect_covariance(field, points, [&](Vec2 p, Vec2 q) {
    const auto index = [](Vec2 r) { return std::find(points.begin(), points.end(), r) - points.begin(); };
    double sum = 0;
    for (const auto& column : columns) sum += column[index(p)] * column[index(q)];
    return sum;
  });
}

// With 3,000 modes what is missing is a small part of the sampling error, so the samples show the exponential itself.
TEST(FieldStatistics, CovarianceOfManyModesIsTheExponential) {
  const FieldSpec spec{.ell_x = 3.0, .ell_y = 3.0, .terms = 3000};
  const RandomField field(spec, slide, 0.1);
  ASSERT_GT(field.captured_variance(), 0.995);
  expect_covariance(field, {{0.5, 2.5}, {3.0, 3.5}, {3.5, 3.0}, {5.5, 4.5}},
                    [](Vec2 p, Vec2 q) { return std::exp(-std::abs(p.x - q.x) / 3.0 - std::abs(p.y - q.y) / 3.0); });
}

/// Probability of a chi-square as far out as this, in the nearer tail.
double tail(double statistic, double degrees) {
  const boost::math::chi_squared_distribution<double> law(degrees);
  return std::min(cdf(law, statistic), cdf(complement(law, statistic)));
}

double probability(double x) { return cdf(boost::math::normal_distribution<double>(), x); }

using Draw = std::function<double(std::uint32_t)>;

/// Chi-square of n draws in 100 classes of equal probability.
double uniformity(const Draw& draw, std::uint32_t n) {
  std::vector<double> counts(100);
  for (std::uint32_t i = 0; i < n; ++i) ++counts[static_cast<std::size_t>(probability(draw(i)) * 100)];
  double statistic = 0;
  for (double count : counts) statistic += (count - n / 100.0) * (count - n / 100.0) / (n / 100.0);
  return tail(statistic, 99);
}

/// Chi-square of the joint classes (10 x 10, equal probabilities) of n pairs.
double independence(const Draw& one, const Draw& other, std::uint32_t n) {
  std::vector<double> counts(100);
  for (std::uint32_t i = 0; i < n; ++i)
    ++counts[10 * static_cast<std::size_t>(probability(one(i)) * 10) +
             static_cast<std::size_t>(probability(other(i)) * 10)];
  double statistic = 0;
  for (double count : counts) statistic += (count - n / 100.0) * (count - n / 100.0) / (n / 100.0);
  return tail(statistic, 99);
}

constexpr std::uint32_t draws = 1'000'000;

TEST(StreamStatistics, NormalAlongModesRealizationsAndSeeds) {
  EXPECT_GT(uniformity([](auto i) { return standard_normal(1, 0, i); }, draws), p_bound);
  EXPECT_GT(uniformity([](auto i) { return standard_normal(1, i, 0); }, draws), p_bound);
  EXPECT_GT(uniformity([](auto i) { return standard_normal(i, 0, 0); }, draws), p_bound);
}

TEST(StreamStatistics, NeighboursAreIndependent) {
  const Draw base = [](auto i) { return standard_normal(7, i, 3); };
  EXPECT_GT(independence(
                base, [](auto i) { return standard_normal(7, i, 4); }, draws),
            p_bound);
  EXPECT_GT(independence(
                base, [](auto i) { return standard_normal(7, i + 1, 3); }, draws),
            p_bound);
  EXPECT_GT(independence(
                base, [](auto i) { return standard_normal(8, i, 3); }, draws),
            p_bound);
  // its own other stream
  EXPECT_GT(independence(
                base,
                [](auto i) {
                  return quantile(boost::math::normal_distribution<double>(), uniforms(7, i, 3, Stream::jitter)[0]);
                },
                draws / 10),
            p_bound);
}

TEST(StreamStatistics, DependenceWouldBeSeen) {
  const Draw base = [](auto i) { return standard_normal(7, i, 3); };
  EXPECT_LT(independence(
                base, [&](auto i) { return 0.02 * base(i) + 0.9998 * standard_normal(7, i, 4); }, draws),
            p_bound);
  EXPECT_LT(uniformity([&](auto i) { return 1.02 * base(i); }, draws), p_bound);
}

// In a Latin hypercube the modes are paired at random: their rank correlations scatter about 0 with 1/sqrt(N-1).
TEST(StreamStatistics, StrataOfDifferentModesAreUncorrelated) {
  constexpr std::uint64_t n = 2000;
  constexpr std::size_t modes = 4;
  std::vector<double> sum(modes * modes);
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto xi = stratified_normals(5, n, i, modes);
    for (std::size_t a = 0; a < modes; ++a)
      for (std::size_t b = 0; b < a; ++b)
        sum[a * modes + b] += 12 * (probability(xi[a]) - 0.5) * (probability(xi[b]) - 0.5) / n;
  }
  for (double correlation : sum) EXPECT_NEAR(correlation, 0, z_bound / std::sqrt(n - 1));
}

// Every order of three strata comes with probability 1/6 over seeds (chi-square, 5 degrees of freedom).
TEST(StreamStatistics, PermutationsAreUniform) {
  constexpr int seeds = 60'000;
  std::vector<double> counts(6);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    int place[3];
    for (std::uint64_t i = 0; i < 3; ++i)
      place[i] = static_cast<int>(probability(stratified_normals(seed, 3, i, 1)[0]) * 3);
    ++counts[static_cast<std::size_t>(2 * place[0] + (place[1] > place[2]))];
  }
  double statistic = 0;
  for (double count : counts) statistic += (count - seeds / 6.0) * (count - seeds / 6.0) / (seeds / 6.0);
  EXPECT_GT(tail(statistic, 5), p_bound);
}

}  // namespace
}  // namespace talus

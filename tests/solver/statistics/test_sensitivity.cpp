// Shares of the variance by regression: against algebra, and how often their intervals hold the true shares.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "statistics/sensitivity.hpp"

namespace talus {
namespace {

using Columns = std::vector<std::vector<double>>;
const std::vector<std::size_t> groups{0, 1, 0};

struct LinearDraws {
  std::vector<double> y;
  Columns controls;
};

/// y = 2 xi_0 - xi_1 + xi_2 + noise: variances 4 + 1 in group 0, 1 in group 1, 2 of the noise; 8 in all.
LinearDraws linear_draws(std::size_t n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  LinearDraws d{.y = std::vector<double>(n), .controls = Columns(3, std::vector<double>(n))};
  for (std::size_t i = 0; i < n; ++i) {
    for (auto& column : d.controls) column[i] = normal(random);
    d.y[i] = 10 + 2 * d.controls[0][i] - d.controls[1][i] + d.controls[2][i] + std::sqrt(2.0) * normal(random);
  }
  return d;
}

std::vector<VarianceShare> shares(const LinearDraws& d) {
  Regression all(d.y);
  for (std::size_t k = 0; k < d.controls.size(); ++k) all.add(d.controls[k], k);
  return variance_shares(all, d.y, groups, 3);
}

TEST(VarianceShares, OfAnExactModelAreThoseOfItsSlopes) {
  std::mt19937_64 random(1);
  LinearDraws d = linear_draws(40, random);
  for (std::size_t i = 0; i < d.y.size(); ++i) d.y[i] = 10 + 2 * d.controls[0][i] - d.controls[1][i] + d.controls[2][i];
  const auto found = shares(d);
  EXPECT_NEAR(found[0].value, 5.0 / 6, 1e-9);
  EXPECT_NEAR(found[1].value, 1.0 / 6, 1e-9);
  EXPECT_NEAR(*found[1].ci95.lo, 1.0 / 6, 1e-6);  // the variance of the controls is known: nothing is uncertain
  EXPECT_EQ(found[2].value, 0.0);
}

/// 2,000 samples of 60: the frequency of an interval is off by less than 0.0049 z, z = 3; the mean of the estimates,
/// whose standard deviation is below 0.09, by less than 0.002 z.
TEST(VarianceShares, HoldTheTrueSharesAsOftenAsTheySay) {
  constexpr int samples = 2000;
  const std::vector<double> truth{5.0 / 8, 1.0 / 8};
  std::mt19937_64 random(2);
  std::vector<double> held(2, 0.0), mean(2, 0.0);
  for (int s = 0; s < samples; ++s) {
    const auto found = shares(linear_draws(60, random));
    for (std::size_t g = 0; g < 2; ++g) {
      held[g] += *found[g].ci95.lo <= truth[g] && truth[g] <= *found[g].ci95.hi ? 1.0 / samples : 0.0;
      mean[g] += found[g].value / samples;
    }
  }
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_NEAR(held[g], 0.95, 0.02 + 3 * 0.0049) << g;
    EXPECT_NEAR(mean[g], truth[g], 3 * 0.002 + 0.004) << g;
  }
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "linear_sampler.hpp"
#include "random_field/covariance.hpp"
#include "random_field/grid_expansion.hpp"
#include "random_field/karhunen_loeve.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

constexpr Box oblong{{-1.0, 2.0}, {5.0, 4.0}};

FieldSpec matern(int terms) {
  return {.ell_x = 2.0, .ell_y = 0.7, .terms = terms, .covariance = Covariance::matern_3_2};
}

std::string fault_of(const FieldSpec& spec) {
  try {
    GridExpansion(spec, oblong, 0.1);
  } catch (const ConfigError& error) {
    return error.faults.at(0).pointer;
  }
  return "";
}

// For the separable exponential the eigenvalues are known in closed form. Cells of a tenth of the correlation length
// carry up to a hundredth more in their middles than the continuous field does.
TEST(GridExpansion, SharesOfTheExponentialAreThoseOfTheClosedModes) {
  const FieldSpec spec{.ell_x = 2.0, .ell_y = 0.7, .terms = 30};
  const GridExpansion expansion(spec, oblong, 0.1);
  const KarhunenLoeve closed(spec, oblong, 0.1);
  ASSERT_EQ(expansion.terms(), 30u);
  for (std::size_t k = 0; k < 30; ++k)
    EXPECT_NEAR(expansion.shares()[k], closed.pairs()[k].lambda / (6.0 * 2.0), 0.002 + 0.03 * expansion.shares()[k])
        << k;
  EXPECT_NEAR(expansion.captured_variance(), closed.captured_variance(), 0.01);
}

TEST(GridExpansion, SharesFallAndTheirSumIsTheCapturedVariance) {
  const GridExpansion expansion(matern(40), oblong, 0.1);
  EXPECT_TRUE(std::is_sorted(expansion.shares().rbegin(), expansion.shares().rend()));
  EXPECT_DOUBLE_EQ(expansion.captured_variance(),
                   std::accumulate(expansion.shares().begin(), expansion.shares().end(), 0.0));
  EXPECT_LT(expansion.captured_variance(), 1);
  EXPECT_LT(GridExpansion(matern(10), oblong, 0.1).captured_variance(), expansion.captured_variance());
}

// Nothing is lost between "its own" modes and the sampled field.
TEST(GridExpansion, VarianceIsThatOfTheResponses) {
  const std::vector<Vec2> points{{-1, 2}, {-0.93, 2.11}, {0.125, 2.375}, {4.9, 3.5}, {5, 4}};
  for (double cell : {0.0, 0.3}) {
    FieldSpec spec = matern(25);
    spec.cell_average = cell > 0;
    const GridExpansion field(spec, oblong, cell);
    const auto responses = test::responses(field, points);
    const auto variance = field.variance(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(variance[i], test::covariance(responses, i, i), 1e-12);
      const auto modes = field.modes_at(points[i]);
      for (std::size_t k = 0; k < modes.size(); ++k) EXPECT_NEAR(modes[k], responses[k][i], 1e-12);
    }
  }
}

TEST(GridExpansion, CovarianceTendsToTheOneAskedFor) {
  const std::vector<Vec2> points{{-0.8, 2.2}, {0.1, 2.3}, {3.3, 3.1}, {4.9, 3.9}};
  FieldSpec spec = matern(300);
  const GridExpansion field(spec, oblong, 0.1);
  EXPECT_GT(field.captured_variance(), 0.98);
  const auto responses = test::responses(field, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      EXPECT_NEAR(test::covariance(responses, i, j), Correlation(spec)(points[i] - points[j]), 0.03) << i << ' ' << j;
}

TEST(GridExpansion, MeanVarianceIsTheMeanOverTheDomain) {
  const GridExpansion field(matern(12), oblong, 0.1);
  std::vector<Vec2> points;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 70; ++j) points.push_back({-1 + 6 * (i + 0.5) / 200, 2 + 2 * (j + 0.5) / 70});
  const auto v = field.variance(points);
  EXPECT_NEAR(field.variance(), std::accumulate(v.begin(), v.end(), 0.0) / 14'000, 1e-3);
  EXPECT_NEAR(field.variance(), field.captured_variance(), 0.01);
}

TEST(GridExpansion, AveragingTakesVarianceAway) {
  FieldSpec spec = matern(60);
  const double whole = GridExpansion(spec, oblong, 0.5).variance();
  spec.cell_average = true;
  const double averaged = GridExpansion(spec, oblong, 0.5).variance();
  EXPECT_NEAR(averaged / whole, Correlation(spec).cell_variance(0.5), 0.04);
  EXPECT_LT(averaged, 0.97 * whole);
}

TEST(GridExpansion, DoesNotDependOnTheParticleSpacing) {
  const GridExpansion coarse(matern(12), oblong, 0.4), fine(matern(12), oblong, 0.1);
  const std::vector<Vec2> points{{-0.8, 2.2}, {0.1, 2.3}, {3.3, 3.1}};
  const std::vector<double> xi{1, -2, 0.3, 0.4, 0.5, 1, 2, 3, -1, 1, 0.1, 0.7};
  EXPECT_EQ(coarse.gaussian(points, xi), fine.gaussian(points, xi));
}

TEST(GridExpansion, ReachesAShareWithAsFewModesAsItTakes) {
  FieldSpec spec = matern(5);
  spec.truncation = Truncation::variance_share;
  spec.variance_share = 0.9;
  const GridExpansion field(spec, oblong, 0.1);
  EXPECT_GE(field.captured_variance(), 0.9);
  EXPECT_LT(field.captured_variance() - field.shares().back(), 0.9);
}

TEST(GridExpansion, OneDirectionIsConstantAcross) {
  FieldSpec spec = matern(8);
  spec.direction = FieldDirection::x;
  const GridExpansion field(spec, oblong, 0.1);
  const std::vector<double> xi{1, -2, 0.3, 0.4, 0.5, 1, 2, 3};
  const auto z = field.gaussian(std::vector<Vec2>{{0.3, 2.0}, {0.3, 4.0}, {0.9, 2.0}}, xi);
  EXPECT_EQ(z[0], z[1]);
  EXPECT_NE(z[0], z[2]);
}

TEST(GridExpansion, RefusesMoreModesThanItHas) {
  EXPECT_EQ(fault_of(matern(501)), "/random_field/terms");
  FieldSpec spec{.direction = FieldDirection::x, .ell_x = 0.02, .covariance = Covariance::exponential_isotropic};
  spec.truncation = Truncation::variance_share;
  EXPECT_EQ(fault_of(spec), "/random_field/variance_share");
}

}  // namespace
}  // namespace talus

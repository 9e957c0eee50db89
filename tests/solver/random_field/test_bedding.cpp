#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "linear_sampler.hpp"
#include "random_field/bedding.hpp"
#include "random_field/random_field.hpp"

namespace talus {
namespace {

constexpr Box slide{{0.0, 2.0}, {4.0, 5.0}};
constexpr double dip = std::numbers::pi / 6;

TEST(Bedding, FallsTowardsTheRight) {
  const Bedding bedding(dip);
  const Vec2 along{std::cos(dip), -std::sin(dip)};
  EXPECT_NEAR(bedding.turned(3.0 * along).x, 3, 1e-15);
  EXPECT_NEAR(bedding.turned(3.0 * along).y, 0, 1e-15);
  EXPECT_EQ(Bedding(0).turned(Vec2{1.1, 2.3}), (Vec2{1.1, 2.3}));
}

TEST(Bedding, BoxAroundHoldsTheCorners) {
  const Box around = Bedding(dip).around(slide);
  EXPECT_NEAR(around.width(), 4 * std::cos(dip) + 3 * std::sin(dip), 1e-14);
  EXPECT_NEAR(around.height(), 4 * std::sin(dip) + 3 * std::cos(dip), 1e-14);
}

// Two points on a line that falls to the right with the dip are correlated as along the bedding.
TEST(Bedding, TurnsTheCorrelationOfEverySampler) {
  const Vec2 along{std::cos(dip), -std::sin(dip)}, across{std::sin(dip), std::cos(dip)}, middle{2.0, 3.5};
  const std::vector<Vec2> points{middle, middle + 0.8 * along, middle + 0.8 * across};
  for (const Covariance family : {Covariance::exponential, Covariance::squared_exponential})
    for (const FieldSampler sampler : {FieldSampler::karhunen_loeve, FieldSampler::circulant_embedding}) {
      FieldSpec spec{.ell_x = 2.0, .ell_y = 1.0, .sampler = sampler, .terms = 150, .covariance = family, .dip = dip};
      if (sampler == FieldSampler::circulant_embedding) spec.grid_spacing = 0.2;
      const RandomField field(spec, slide, 0.1);
      const auto responses = test::responses(field, points);
      const double tolerance = sampler == FieldSampler::karhunen_loeve ? 0.06 : 0.1;  // of the nearest node
      EXPECT_NEAR(test::covariance(responses, 0, 1), Correlation(spec)({0.8, 0}), tolerance);
      EXPECT_NEAR(test::covariance(responses, 0, 2), Correlation(spec)({0, 0.8}), tolerance);
    }
}

TEST(Nugget, IsWhiteAndTakesItsShare) {
  FieldSpec spec{.ell_x = 2.0, .ell_y = 1.0, .terms = 20, .covariance = Covariance::matern_3_2, .nugget = 0.3};
  const RandomField field(spec, slide, 0.1);
  spec.nugget = 0;
  const RandomField smooth(spec, slide, 0.1);
  EXPECT_EQ(field.terms(), smooth.terms() + 1);
  EXPECT_DOUBLE_EQ(field.variance(), 0.7 * smooth.variance() + 0.3);
  EXPECT_DOUBLE_EQ(field.captured_variance(), 0.7 * smooth.captured_variance() + 0.3);
  const std::vector<Vec2> points{{1.0, 3.0}, {1.1, 3.0}, {1.0, 3.1}};
  EXPECT_DOUBLE_EQ(field.variance(points)[1], 0.7 * smooth.variance(points)[1] + 0.3);
  std::vector<double> xi(field.terms(), 0.0);
  for (const double value : field.gaussian(points, xi)) EXPECT_EQ(value, 0);
  std::vector<double> modes(smooth.terms(), 0.7);
  std::copy(modes.begin(), modes.end(), xi.begin());  // without noise: the smooth part alone, of the variance 0.7
  EXPECT_NEAR(field.gaussian(points, xi)[0], std::sqrt(0.7) * smooth.gaussian(points, modes)[0], 1e-14);
  xi.back() = 0.4;
  const auto one = field.gaussian(points, xi);
  xi.back() = 0.5;
  const auto other = field.gaussian(points, xi);
  EXPECT_NE(one[0], one[1]);
  EXPECT_NE(one[0], one[2]);
  EXPECT_NE(one[0], other[0]);
  // a point has its value in any company
  EXPECT_EQ(field.gaussian(std::vector<Vec2>{points[2]}, xi)[0], other[2]);
}

}  // namespace
}  // namespace talus

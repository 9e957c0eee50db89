#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/quadrature.hpp"
#include "random_field/circulant_embedding.hpp"

namespace talus {
namespace {

/// The average over both cells as a double integral, the inner one split at its kink.
double averaged_by_quadrature(double d, double ell, double h) {
  return integrate(
      [&](double u) {
        const auto inner = [&](double v) { return std::exp(-std::abs(d + u - v) / ell); };
        const double kink = std::clamp(d + u, 0.0, h);
        return (integrate(inner, 0.0, kink) + integrate(inner, kink, h)) / (h * h);
      },
      0.0, h, 200);
}

TEST(ExponentialCovariance, AtAPoint) {
  const ExponentialCovariance c{.ell = 0.7};
  EXPECT_EQ(c(0), 1);
  EXPECT_DOUBLE_EQ(c(1.4), std::exp(-2));
  EXPECT_DOUBLE_EQ(c(-1.4), std::exp(-2));
}

TEST(ExponentialCovariance, CellAverageEqualsTheDoubleIntegral) {
  for (double ell : {0.2, 1.7})
    for (double h : {0.1, 0.5})
      for (double d : {0.0, 0.03, 0.1, 0.4999, 0.5, 0.8, 3.0}) {
        const ExponentialCovariance c{.ell = ell, .cell = h};
        EXPECT_NEAR(c(d), averaged_by_quadrature(d, ell, h), 1e-6) << ell << ' ' << h << ' ' << d;
        EXPECT_EQ(c(d), c(-d));
      }
}

/// Vanmarcke's variance function with the scale of fluctuation 2 ell: 2 (ell/h)^2 (h/ell - 1 + exp(-h/ell)).
TEST(ExponentialCovariance, VarianceFunction) {
  const double ell = 0.5, h = 0.3;
  EXPECT_NEAR((ExponentialCovariance{ell, h}(0)), 2 * std::pow(ell / h, 2) * (h / ell - 1 + std::exp(-h / ell)), 1e-14);
}

TEST(ExponentialCovariance, SmallCellsTendToThePoint) {
  for (double d : {0.0, 0.2, 2.0}) EXPECT_NEAR((ExponentialCovariance{1.0, 1e-3}(d)), std::exp(-d), 1e-3 / 3 + 1e-6);
}

}  // namespace
}  // namespace talus

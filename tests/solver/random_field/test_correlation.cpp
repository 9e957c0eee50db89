#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "quadrature.hpp"
#include "random_field/circulant_embedding.hpp"
#include "random_field/covariance.hpp"
#include "random_field/field_spec.hpp"

namespace talus {
namespace {

constexpr Covariance families[] = {Covariance::exponential,         Covariance::exponential_isotropic,
                                   Covariance::squared_exponential, Covariance::matern_3_2,
                                   Covariance::matern_5_2,          Covariance::cosine_exponential};

FieldSpec of(Covariance family, double ell_x = 1.3, double ell_y = 0.4) {
  return {.ell_x = ell_x, .ell_y = ell_y, .covariance = family};
}

TEST(Correlation, ClosedForms) {
  const Vec2 lag{-0.7, 0.3};
  const double x = 0.7 / 1.3, y = 0.3 / 0.4, r = std::hypot(x, y);
  const double s3 = std::sqrt(3.0) * r, s5 = std::sqrt(5.0) * r;
  EXPECT_DOUBLE_EQ(Correlation(of(Covariance::exponential))(lag), std::exp(-x - y));
  EXPECT_DOUBLE_EQ(Correlation(of(Covariance::exponential_isotropic))(lag), std::exp(-r));
  EXPECT_DOUBLE_EQ(Correlation(of(Covariance::squared_exponential))(lag), std::exp(-r * r));
  EXPECT_DOUBLE_EQ(Correlation(of(Covariance::matern_3_2))(lag), (1 + s3) * std::exp(-s3));
  EXPECT_DOUBLE_EQ(Correlation(of(Covariance::matern_5_2))(lag), (1 + s5 + s5 * s5 / 3) * std::exp(-s5));
  EXPECT_DOUBLE_EQ(Correlation(of(Covariance::cosine_exponential))(lag), std::exp(-x - y) * std::cos(x) * std::cos(y));
}

// The definition: theta = integral of the correlation along an axis.
TEST(Correlation, ScaleOfFluctuationIsTheIntegral) {
  for (const Covariance family : families) {
    const Correlation rho(of(family));
    const double theta = 2 * integrate([&](double d) { return rho({d, 0}); }, 0.0, 40 * 1.3, 20'000);
    EXPECT_NEAR(theta, scale_of_fluctuation_factor(family) * 1.3, 1e-6) << static_cast<int>(family);
  }
}

TEST(Correlation, DoesNotChangeAlongAnAxisWithoutVariation) {
  for (const Covariance family : families) {
    FieldSpec spec = of(family);
    spec.direction = FieldDirection::y;
    const Correlation rho(spec);
    EXPECT_EQ(rho({7.0, 0.0}), 1);
    EXPECT_EQ(rho({7.0, 0.3}), Correlation(of(family))({0.0, 0.3}));
  }
}

TEST(Correlation, CellVarianceOfTheExponentialIsTheProductOfVarianceFunctions) {
  for (double h : {0.01, 0.5, 4.0})
    EXPECT_NEAR(Correlation(of(Covariance::exponential)).cell_variance(h),
                (ExponentialCovariance{1.3, h}(0)) * (ExponentialCovariance{0.4, h}(0)), 1e-9)
        << h;
}

/// Vanmarcke's variance function of exp(-(d/ell)^2), with q = h/ell: (sqrt(pi) q erf(q) + exp(-q^2) - 1) / q^2.
TEST(Correlation, CellVarianceOfTheSquaredExponential) {
  const auto reduction = [](double q) {
    return (std::sqrt(std::numbers::pi) * q * std::erf(q) + std::exp(-q * q) - 1) / (q * q);
  };
  for (double h : {0.1, 0.5, 4.0})
    EXPECT_NEAR(Correlation(of(Covariance::squared_exponential)).cell_variance(h),
                reduction(h / 1.3) * reduction(h / 0.4), 1e-9)
        << h;
}

// The mean over a cell of the correlation with its own points, averaged over these points, is the variance of the mean.
TEST(Correlation, WithCellAveragesToTheCellVariance) {
  for (const Covariance family : families)
    for (double h : {0.1, 0.6}) {
      const Correlation rho(of(family));
      constexpr int n = 20;
      double mean = 0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          mean += rho.with_cell({h * ((i + 0.5) / n - 0.5), h * ((j + 0.5) / n - 0.5)}, h) / (n * n);
      EXPECT_NEAR(mean, rho.cell_variance(h), 0.01) << static_cast<int>(family) << ' ' << h;
    }
}

TEST(Correlation, WithoutACellItIsThePoint) {
  const Correlation rho(of(Covariance::matern_3_2));
  EXPECT_EQ(rho.with_cell({0.2, 0.1}, 0.0), rho({0.2, 0.1}));
  EXPECT_EQ(rho.cell_variance(0.0), 1);
}

}  // namespace
}  // namespace talus

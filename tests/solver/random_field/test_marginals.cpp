#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "quadrature.hpp"
#include "random_field/random_field.hpp"

namespace talus {
namespace {

// [Z20] Table 4: its COV of 0.1 .. 0.5 is sigma/|mu|; the true coefficients of variation of tan(phi).
TEST(LogStdev, OfThePapersCases) {
  const double sigmas[] = {0.0763, 0.1526, 0.2289, 0.3052, 0.3814};
  const double covs[] = {0.076, 0.153, 0.232, 0.312, 0.396};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(log_stdev(covs[i]), sigmas[i], 5e-4);
}

// Z of variance V, not 1: truncation or averaging took the rest.
TEST(LogMedians, GiveTheMomentsAsIntegralsOverTheDensity) {
  const std::vector<double> variances{1.0, 0.4, 0.01};
  for (const double cov : {1e-3, 0.1, 0.35, 0.8}) {
    const double sigma = log_stdev(cov);
    const auto mu = log_medians(0.4663, sigma, variances);
    for (std::size_t i = 0; i < variances.size(); ++i) {
      const auto moment = [&](int power) {
        return integrate(
            [&](double z) {
              const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
              return density * std::pow(std::exp(mu[i] + sigma * std::sqrt(variances[i]) * z), power);
            },
            -12.0, 12.0, 20);
      };
      const double left = coefficient_of_variation(sigma, variances[i]);
      EXPECT_NEAR(moment(1), 0.4663, 1e-13);
      EXPECT_NEAR(moment(2), 0.4663 * 0.4663 * (1 + left * left), 1e-13);
    }
    EXPECT_NEAR(coefficient_of_variation(sigma, 1.0), cov, 1e-14);
  }
  EXPECT_EQ(log_stdev(0.0), 0.0);
  EXPECT_DOUBLE_EQ(log_medians(0.5, 0.0, variances)[1], std::log(0.5));
}

TEST(Lognormal, OneMeanForAllOrOneForEach) {
  const std::vector<double> z{0.0, 1.0, -2.0}, one{-0.5}, each{-0.5, 0.25, 1.0};
  const auto a = lognormal(z, one, 0.3), b = lognormal(z, each, 0.3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(a[i], std::exp(-0.5 + 0.3 * z[i]));
    EXPECT_DOUBLE_EQ(b[i], std::exp(each[i] + 0.3 * z[i]));
  }
  EXPECT_THROW(lognormal(z, std::vector<double>{1, 2}, 0.3), std::invalid_argument);
}

TEST(Lognormal, NegativeSigmaMirrorsTheDraws) {
  const std::vector<double> z{0.4, 1.0, -2.0}, mirrored{-0.4, -1.0, 2.0}, mu{-0.7629};
  EXPECT_EQ(lognormal(z, mu, -0.2289), lognormal(mirrored, mu, 0.2289));
}

}  // namespace
}  // namespace talus

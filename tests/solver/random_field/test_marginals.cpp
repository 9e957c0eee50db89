#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "math/quadrature.hpp"
#include "random_field/random_field.hpp"

namespace talus {
namespace {

// [Z20] Table 4: its COV of 0.1 .. 0.5 is sigma/|mu|; the true coefficients of variation of tan(phi).
TEST(LogParameters, OfThePapersCases) {
  const double sigmas[] = {0.0763, 0.1526, 0.2289, 0.3052, 0.3814};
  const double covs[] = {0.076, 0.153, 0.232, 0.312, 0.396};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(log_parameters({.mean = 0.5, .cov = covs[i]}).sigma, sigmas[i], 5e-4);
}

TEST(LogParameters, GiveTheMomentsAsIntegralsOverTheDensity) {
  for (const double cov : {1e-3, 0.1, 0.35, 0.8}) {
    const LogParameters log = log_parameters({.mean = 0.4663, .cov = cov});
    const auto moment = [&](int power) {
      return integrate(
          [&](double z) {
            const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
            return density * std::pow(std::exp(log.mu + log.sigma * z), power);
          },
          -12.0, 12.0, 20);
    };
    EXPECT_NEAR(moment(1), 0.4663, 1e-13);
    EXPECT_NEAR(moment(2), 0.4663 * 0.4663 * (1 + cov * cov), 1e-13);
  }
  EXPECT_EQ(log_parameters({.mean = 0.5, .cov = 0.0}).sigma, 0.0);
  EXPECT_DOUBLE_EQ(log_parameters({.mean = 0.5, .cov = 0.0}).mu, std::log(0.5));
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

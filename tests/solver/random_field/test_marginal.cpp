#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "random_field/marginal.hpp"
#include "random_field/stream.hpp"

namespace talus {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
constexpr int draws = 20'000;

/// Central moments of 20,000 draws of one seed, and how far they may be off.
struct Sample {
  double mean = 0.0, stdev = 0.0, mean_error = 0.0, stdev_error = 0.0, below_median = 0.0;
};

Sample sample_of(const Marginal& m) {
  std::vector<double> xs;
  for (std::uint64_t i = 0; i < draws; ++i) xs.push_back(m.value(standard_normal(17, i, 0)));
  double sum = 0, s2 = 0, s4 = 0, below = 0;
  const double median = m.value(0.0);
  for (const double x : xs) sum += x / draws;
  for (const double x : xs) {
    const double d = x - sum;
    s2 += d * d / draws;
    s4 += d * d * d * d / draws;
    below += x < median;
  }
  return {sum, std::sqrt(s2), std::sqrt(s2 / draws), std::sqrt((s4 - s2 * s2) / (4 * s2 * draws)), below / draws};
}

// Mean and standard deviation of 20,000 draws within z = 4 of their standard errors (false alarm 6e-5 each; the error
// of the standard deviation is that of its own fourth moment), half of them below the median within 4 sqrt(1/4/20,000).
TEST(Marginal, DrawsHaveTheMomentsAskedFor) {
  for (const Marginal& m :
       {lognormal_marginal(5e3, 0.4), normal_marginal(20, 3, -none, none), normal_marginal(2, 1, 0, none),
        normal_marginal(2, 1.6, 0, none), normal_marginal(0.5, 0.14, 0.3, 1.0), normal_marginal(8, 1.7, 0, 10),
        beta_marginal(3, 0.8, 1, 9), beta_marginal(0.5, 0.45, 0, 1), uniform_marginal(200, 800)}) {
    const Sample s = sample_of(m);
    EXPECT_NEAR(s.mean, m.mean, 4 * s.mean_error) << m.mean;
    EXPECT_NEAR(s.stdev, m.stdev, 4 * s.stdev_error) << m.mean;
    EXPECT_LT(s.stdev_error, 0.02 * m.stdev);
    EXPECT_NEAR(s.below_median, 0.5, 4 * std::sqrt(0.25 / draws));
  }
}

// Quantiles in closed form.
TEST(Marginal, QuantilesOfTheClosedForms) {
  const boost::math::normal_distribution<double> normal;
  for (const double p : {1e-6, 0.01, 0.3, 0.5, 0.84, 0.999999}) {
    const double z = quantile(normal, p);
    const double sigma2 = std::log1p(0.3 * 0.3);
    EXPECT_NEAR(lognormal_marginal(4, std::sqrt(sigma2)).value(z), 4 * std::exp(std::sqrt(sigma2) * z - sigma2 / 2),
                1e-12);
    EXPECT_NEAR(uniform_marginal(2, 6).value(z), 2 + 4 * p, 1e-12);
    EXPECT_NEAR(normal_marginal(7, 2, -none, none).value(z), 7 + 2 * z, 1e-12);
    // Beta with exponents 1 and 2: F = 1 - (1 - x)^2, mean 1/3, variance 1/18.
    EXPECT_NEAR(beta_marginal(1.0 / 3, std::sqrt(1.0 / 18), 0, 1).value(z), 1 - std::sqrt(1 - p), 1e-9);
    // Half of a normal distribution: F = 2 Phi(x) - 1, mean sqrt(2/pi), variance 1 - 2/pi.
    EXPECT_NEAR(normal_marginal(std::sqrt(2 / std::numbers::pi), std::sqrt(1 - 2 / std::numbers::pi), 0, none).value(z),
                quantile(normal, 0.5 + p / 2), 1e-7);
  }
}

TEST(Marginal, RisesAndStaysWithinItsBounds) {
  for (const Marginal& m : {normal_marginal(2, 1.9, 0, none), normal_marginal(0.9, 0.09, 0, 1),
                            beta_marginal(3, 1.2, 1, 9), uniform_marginal(1, 2), lognormal_marginal(1, 0.5)}) {
    double before = m.low;
    for (double z = -9; z <= 9; z += 0.25) {
      const double x = m.value(z);
      EXPECT_GE(x, before) << m.mean << " at " << z;
      EXPECT_LE(x, m.high);
      before = x;
    }
  }
}

TEST(Marginal, AveragingKeepsTheMean) {
  for (const Marginal& m : {normal_marginal(2, 1, 0, none), beta_marginal(3, 1, 1, 9), uniform_marginal(1, 2)}) {
    const Marginal a = m.averaged(0.49);
    EXPECT_NEAR(a.mean, m.mean, 1e-12);
    EXPECT_NEAR(a.stdev, 0.7 * m.stdev, 1e-9);
  }
  const Marginal a = lognormal_marginal(3, 0.5).averaged(0.49);
  EXPECT_DOUBLE_EQ(a.mean, 3);
  EXPECT_NEAR(a.cov(), std::sqrt(std::expm1(0.25 * 0.49)), 1e-12);
}

TEST(Marginal, ConstantIsItsValueWhateverTheDraw) {
  for (const double z : {-3.0, 0.0, 2.0}) EXPECT_EQ(constant_marginal(0.3).value(z), 0.3);
  EXPECT_EQ(normal_marginal(2, 0, 0, none).kind, MarginalKind::constant);
}

std::string refusal(auto&& make) try {
  make();
  return "";
} catch (const std::domain_error& e) {
  return e.what();
}

// A normal distribution cut off at 0 has at most the coefficient of variation 1, that of the exponential distribution;
// of a beta distribution, nearly all lies at the bounds beyond sqrt((m - a)(b - m)).
TEST(Marginal, SaysWhatCannotBe) {
  EXPECT_NE(refusal([] { normal_marginal(2, 2.1, 0, none); }).find("at most 1;"), std::string::npos);
  EXPECT_EQ(refusal([] { normal_marginal(2, 1.95, 0, none); }), "");
  EXPECT_NE(refusal([] { normal_marginal(2, 1, 3, 5); }).find("between low and high"), std::string::npos);
  EXPECT_NE(refusal([] { beta_marginal(0.5, 0.5, 0, 1); }).find("below 0.953"), std::string::npos);
  EXPECT_NE(refusal([] { uniform_marginal(2, 2); }).find("low is not below high"), std::string::npos);
  EXPECT_NE(refusal([] { lognormal_marginal(0, 0.1); }).find("above 0"), std::string::npos);
}

// What a case may state: the mean of the material, mean or median, in any form.
TEST(MakeMarginal, TakesTheMaterialsValueForAMeanThatIsNotStated) {
  PropertySpec spec{.property = Property::cohesion, .cov = 0.3};
  EXPECT_DOUBLE_EQ(make_marginal(spec, 5e3).mean, 5e3);
  EXPECT_NEAR(make_marginal(spec, 5e3).cov(), 0.3, 1e-12);
  spec = {.property = Property::cohesion, .log_stdev = 0.5};
  EXPECT_NEAR(make_marginal(spec, 5e3).value(0), 5e3, 1e-9);
  EXPECT_NEAR(make_marginal(spec, 5e3).mean, 5e3 * std::exp(0.125), 1e-9);
  spec.log_mean = std::log(7e3);
  EXPECT_NEAR(make_marginal(spec, 5e3).value(1), 7e3 * std::exp(0.5), 1e-8);
  spec = {.property = Property::cohesion, .marginal = MarginalKind::uniform, .mean = 6.0, .stdev = 1.0};
  EXPECT_NEAR(make_marginal(spec, 0).low, 6 - std::numbers::sqrt3, 1e-12);
  spec = {.property = Property::cohesion, .marginal = MarginalKind::normal, .mean = 6.0, .cov = 0.4};
  EXPECT_EQ(make_marginal(spec, 0).low, 0.0);
  spec.property = Property::unit_weight;
  EXPECT_EQ(make_marginal(spec, 0).low, 3.0);
}

}  // namespace
}  // namespace talus

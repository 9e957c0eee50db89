#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "random_field/correlation_matrix.hpp"
#include "random_field/nataf.hpp"
#include "random_field/stream.hpp"

namespace talus {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

// Two lognormal quantities: rho = (exp(rho' s1 s2) - 1)/sqrt((exp(s1^2) - 1)(exp(s2^2) - 1)).
TEST(Nataf, ClosedFormOfLognormalPairs) {
  for (const double s1 : {0.05, 0.4, 1.0})
    for (const double s2 : {0.2, 0.9})
      for (const double gaussian : {-0.95, -0.4, 0.0, 0.3, 0.8, 1.0}) {
        const double rho = std::expm1(gaussian * s1 * s2) / std::sqrt(std::expm1(s1 * s1) * std::expm1(s2 * s2));
        const Marginal a = lognormal_marginal(3, s1), b = lognormal_marginal(7e3, s2);
        EXPECT_NEAR(correlation_after_marginals(a, b, gaussian), rho, 1e-9);
        EXPECT_NEAR(gaussian_correlation(a, b, rho), gaussian, 1e-8) << s1 << " " << s2;
      }
}

// Two uniform quantities: rho = (6/pi) asin(rho'/2) (Spearman's rank correlation). A normal and a lognormal one:
// rho = rho' s/sqrt(exp(s^2) - 1).
TEST(Nataf, ClosedFormsOfUniformAndMixedPairs) {
  for (const double gaussian : {-0.9, -0.5, 0.2, 0.99}) {
    const double uniform = 6 / std::numbers::pi * std::asin(gaussian / 2);
    EXPECT_NEAR(gaussian_correlation(uniform_marginal(0, 1), uniform_marginal(3, 9), uniform), gaussian, 1e-8);
    const double mixed = gaussian * 0.6 / std::sqrt(std::expm1(0.36));
    EXPECT_NEAR(gaussian_correlation(normal_marginal(1, 2, -none, none), lognormal_marginal(1, 0.6), mixed), gaussian,
                1e-8);
  }
}

// 20,000 pairs with rho' from Nataf's transformation have the correlation asked for, within z = 4 standard errors,
// where the error is that of batches of 200 pairs (false alarm about 1e-4 a pair of distributions).
TEST(Nataf, DrawsHaveTheCorrelationAskedFor) {
  const Marginal marginals[] = {lognormal_marginal(0.5, 0.6), normal_marginal(5, 3, 0, none),
                                beta_marginal(3, 1.5, 1, 9), uniform_marginal(200, 800)};
  for (const Marginal& a : marginals)
    for (const Marginal& b : marginals) {
      if (&a >= &b) continue;
      const double rho = -0.6, gaussian = gaussian_correlation(a, b, rho);
      double mean = 0, squares = 0;
      constexpr int batches = 100, size = 200;
      for (int k = 0; k < batches; ++k) {
        double sum = 0;
        for (int i = 0; i < size; ++i) {
          const auto index = static_cast<std::uint64_t>(size * k + i);
          const double z = standard_normal(3, index, 0), w = standard_normal(3, index, 1);
          const double y = gaussian * z + std::sqrt(1 - gaussian * gaussian) * w;
          sum += (a.value(z) - a.mean) * (b.value(y) - b.mean) / (a.stdev * b.stdev) / size;
        }
        mean += sum / batches;
        squares += sum * sum / batches;
      }
      const double error = std::sqrt((squares - mean * mean) / batches);
      EXPECT_NEAR(mean, rho, 4 * error);
      EXPECT_LT(4 * error, 0.06);
    }
}

TEST(Nataf, NamesTheRangeThatTheDistributionsAllow) {
  const Marginal skew = lognormal_marginal(1, 1.0);
  const double least = std::expm1(-1.0) / std::expm1(1.0);
  EXPECT_NEAR(attainable_correlation(skew, skew).least, least, 1e-9);
  EXPECT_NEAR(attainable_correlation(skew, skew).most, 1.0, 1e-9);
  try {
    gaussian_correlation(skew, skew, -0.5);
    ADD_FAILURE();
  } catch (const std::domain_error& e) {
    EXPECT_NE(std::string(e.what()).find("-0.368 to 1"), std::string::npos) << e.what();
  }
}

CorrelationMatrix three(double ab, double ac, double bc) {
  CorrelationMatrix m(3);
  m.set(0, 1, ab);
  m.set(0, 2, ac);
  m.set(1, 2, bc);
  return m;
}

// Three equal correlations r are possible from -1/2 on.
TEST(CorrelationMatrix, KnowsWhatIsPositiveDefinite) {
  EXPECT_TRUE(three(-0.499, -0.499, -0.499).positive_definite());
  EXPECT_FALSE(three(-0.501, -0.501, -0.501).positive_definite());
  EXPECT_FALSE(three(0.9, 0.9, -0.9).positive_definite());
  EXPECT_TRUE(three(0.9, 0.9, 0.7).positive_definite());
}

// The nearest of three equal correlations below -1/2 is -1/2, by symmetry. And Higham (2002), section 4: the matrix
// with a = b = 1 beside the diagonal and 0 in the corner has the nearest correlation matrix 0.7607, 0.1573.
TEST(CorrelationMatrix, NearestValid) {
  const CorrelationMatrix equal = three(-0.9, -0.9, -0.9).nearest_valid(1e-6);
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) EXPECT_NEAR(equal(i, j), -0.5, 1e-5);
  const CorrelationMatrix higham = three(1, 0, 1).nearest_valid(0.0);
  EXPECT_NEAR(higham(0, 1), 0.7607, 5e-5);
  EXPECT_NEAR(higham(1, 2), 0.7607, 5e-5);
  EXPECT_NEAR(higham(0, 2), 0.1573, 5e-5);
  EXPECT_TRUE(three(0.9, 0.9, -0.9).nearest_valid().positive_definite());
}

TEST(CorrelationMatrix, FactorOfIt) {
  const CorrelationMatrix m = three(-0.5, 0.3, 0.2);
  const std::vector<double> l = m.lower_factor();
  EXPECT_EQ(l[0], 1.0);  // the first property keeps its draws
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += l[3 * i + k] * l[3 * j + k];
      EXPECT_NEAR(sum, m(i, j), 1e-14);
      if (j > i) {
        EXPECT_EQ(l[3 * i + j], 0.0);
      }
    }
}

}  // namespace
}  // namespace talus

#pragma once
// Sample means and covariances of drawn fields against the expected ones.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "random_field/random_field.hpp"

namespace talus::test {

inline constexpr double z_bound = 5;  // 6e-7 a comparison
inline constexpr int draws_of_a_field = 20'000;

/// Sample means and covariances of 20,000 realizations at points, each within z stdev/sqrt(n) of the expected ones; for
/// Gaussian variables of known mean the variance of a product of deviations is C_ii C_jj + C_ij^2.
/// @param mean        shape of `points`
/// @param covariance  (i, j) -> the expected one of points i and j
template <class Covariance>
void expect_moments(const RandomField& field, const std::vector<Vec2>& points, const std::vector<double>& mean,
                    const Covariance& covariance) {
  constexpr int n = draws_of_a_field;
  const std::size_t m = points.size();
  std::vector<double> products(m * m), sums(m);
  for (int k = 0; k < n; ++k) {
    const auto z = field.gaussian(points, field.draw(2024, static_cast<std::uint64_t>(k)));
    for (std::size_t i = 0; i < m; ++i) {
      sums[i] += (z[i] - mean[i]) / n;
      for (std::size_t j = 0; j <= i; ++j) products[i * m + j] += (z[i] - mean[i]) * (z[j] - mean[j]) / n;
    }
  }
  for (std::size_t i = 0; i < m; ++i) {
    EXPECT_NEAR(sums[i], 0, z_bound * std::sqrt(covariance(i, i) / n)) << i;
    for (std::size_t j = 0; j <= i; ++j) {
      const double c = covariance(i, j);
      const double stdev = std::sqrt(covariance(i, i) * covariance(j, j) + c * c);
      EXPECT_NEAR(products[i * m + j], c, z_bound * stdev / std::sqrt(n)) << i << ' ' << j;
    }
  }
}

}  // namespace talus::test

#pragma once
// A sampler is linear in xi, so its covariance is known without sampling: feed it unit vectors.

#include <span>
#include <vector>

#include "math/vec2.hpp"

namespace talus::test {

/// Column k: Z at the points for xi = e_k.
template <class Sampler>
std::vector<std::vector<double>> responses(const Sampler& sampler, std::span<const Vec2> points) {
  std::vector<std::vector<double>> columns;
  for (std::size_t k = 0; k < sampler.terms(); ++k) {
    std::vector<double> xi(sampler.terms(), 0.0);
    xi[k] = 1;
    columns.push_back(sampler.gaussian(points, xi));
  }
  return columns;
}

/// Cov(Z_i, Z_j) = sum_k response_k(i) response_k(j).
inline double covariance(const std::vector<std::vector<double>>& responses, std::size_t i, std::size_t j) {
  double sum = 0;
  for (const auto& column : responses) sum += column[i] * column[j];
  return sum;
}

}  // namespace talus::test

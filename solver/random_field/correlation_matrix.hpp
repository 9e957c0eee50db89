#pragma once
// Small correlation matrices: whether one is possible, the nearest that is, and its factor.

#include <cstddef>
#include <vector>

namespace talus {

/// A symmetric matrix with ones on its diagonal, as large as the number of properties.
class CorrelationMatrix {
 public:
  explicit CorrelationMatrix(std::size_t n);  ///< of n quantities that are not correlated

  std::size_t size() const { return n_; }
  double operator()(std::size_t i, std::size_t j) const { return values_[i * n_ + j]; }
  void set(std::size_t i, std::size_t j, double value) { values_[i * n_ + j] = values_[j * n_ + i] = value; }

  /// Whether its least eigenvalue is above 1e-8.
  bool positive_definite() const;
  /// The nearest correlation matrix (Frobenius norm) whose eigenvalues are at least `least_eigenvalue`: alternating
  /// projections with Dykstra's correction (Higham 2002, IMA J. Numer. Anal. 22, 329-343).
  CorrelationMatrix nearest_valid(double least_eigenvalue = 1e-3) const;
  /// Row-major lower triangle L with L L^T = this (Cholesky); this is positive definite.
  std::vector<double> lower_factor() const;

 private:
  std::size_t n_;
  std::vector<double> values_;
};

}  // namespace talus

#pragma once
// Linear regression of a sample on ever more variables, one after the other, by Gram and Schmidt. Pure functions.

#include <cstddef>
#include <span>
#include <vector>

namespace talus {

/// y = b_0 + sum_k b_k c_k + residual by least squares. Keeps the factors of [1 c_1 ... c_K] = Q R. Copies share
/// nothing; safe to read from several threads at once.
class Regression {
 public:
  using Column = std::vector<double>;

  /// @param y  n >= 1 values; b_0 alone to begin with
  explicit Regression(std::span<const double> y);

  /// Adds a variable of n values. @param variable  its place among the caller's variables
  /// @return false where it brings nothing new: it is constant, or a combination of those before it
  bool add(const Column& values, std::size_t variable) { return take(values, variable); }

  /// K, the variables that are used.
  std::size_t size() const { return q_.size() - 1; }
  /// Place of the k-th variable used, 1 <= k <= size(), among the caller's.
  std::size_t variable(std::size_t k) const { return variables_[k]; }
  /// n - K - 1
  double degrees_of_freedom() const;
  double squared_residuals() const;
  const Column& residuals() const { return residual_; }
  /// The residual that each value has in the regression on all the others, e_i / (1 - h_i) with the leverage h_i
  /// (Allen 1974); the sum of their squares is PRESS.
  Column left_out_residuals() const;
  /// The n weights with which y gives b_k: row k of R^-1 Q'. Without value i, b_k is smaller by weights(k)[i] times
  /// left_out_residuals()[i].
  Column weights(std::size_t k) const;

 private:
  bool take(Column column, std::size_t variable);

  Column residual_, leverage_;
  std::vector<Column> q_, r_;  ///< q_[0] is constant; r_[k][j], j <= k
  std::vector<std::size_t> variables_;
};

/// The regression on the first K of `controls`, 0 <= K <= n / runs_per_control, whose PRESS is least.
/// @throws std::invalid_argument where a control has not n values
Regression best_regression(std::span<const double> y, std::span<const Regression::Column> controls);

/// At least so many values of the sample for each control that is used.
inline constexpr std::size_t runs_per_control = 5;

}  // namespace talus

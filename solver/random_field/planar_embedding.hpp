#pragma once
// Gaussian field of any covariance with its full variance on a grid: circulant embedding in two dimensions (Dietrich &
// Newsam 1997; Wood & Chan 1994).

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/covariance.hpp"
#include "random_field/field_grid.hpp"
#include "random_field/field_spec.hpp"

namespace talus {

/// Largest error of the covariance that is accepted [-]; a larger one is refused.
inline constexpr double max_embedding_error = 0.01;

/// A periodic field on m_x by m_y nodes, whose block circulant covariance matrix the FFT diagonalises. Its correlation
/// between nodes less than half a period apart is the one asked for.
class PeriodicField {
 public:
  /// What filter() multiplies the transform with: square roots of the eigenvalues, for drawing, or themselves.
  enum class Spectrum { roots, signed_eigenvalues };
  PeriodicField(const Correlation& correlation, Vec2 spacing, std::size_t period_x, std::size_t period_y,
                Spectrum spectrum = Spectrum::roots);

  std::size_t period_x() const { return period_x_; }
  std::size_t period_y() const { return period_y_; }
  /// Bound of the error of any covariance [-]: negative eigenvalues, which no field has, are set to zero, and the
  /// others scaled so that the variance is 1.
  double error() const { return error_; }
  /// What white noise (period_x period_y numbers, x fastest) becomes: values with the covariance. With signed
  /// eigenvalues, the product of the covariance matrix and a vector.
  void filter(std::span<double> values) const;

 private:
  using Transform = std::vector<std::complex<double>>;
  std::size_t half() const { return period_x_ == 1 ? 1 : period_x_ / 2 + 1; }
  Transform transform(std::span<const double> values) const;

  std::size_t period_x_, period_y_;
  double error_ = 0.0;
  std::vector<double> factors_;  ///< of the half spectrum along x
};

/// Sampler of the field on a grid, x and y being the axes of the bedding.
///
/// A point takes the value of the nearest node, a cell the mean over the cell of that piecewise constant field, scaled
/// to the variance that the mean of the exact field has: the variance is exact everywhere. Periods grow until no
/// eigenvalue is negative, or until the limit of the grid; the error that is left then is error().
class PlanarEmbedding {
 public:
  /// @param spec    what is asked for; its ranges have been checked
  /// @param domain  rectangle that the grid covers [m]; points outside the grid take the value at its nearest node
  /// @param dx      side of the cells that `spec.cell_average` averages over [m]; the grid does not depend on it
  /// @param limit   most coefficients that periods may grow to
  /// @throws ConfigError (/random_field/grid_spacing_m) when the grid is too large, or the error above
  /// max_embedding_error
  PlanarEmbedding(const FieldSpec& spec, Box domain, double dx, double limit = max_grid);

  /// Number of coefficients: white noise on the whole periodic grid.
  std::size_t terms() const { return periodic_.period_x() * periodic_.period_y(); }
  double captured_variance() const { return 1.0; }
  double error() const { return periodic_.error(); }
  /// Variance of Z [-]: 1, less what averaging over cells takes away.
  double variance() const { return variance_; }
  /// Variance of Z at points [-], shape of `points`: the same everywhere.
  std::vector<double> variance(std::span<const Vec2> points) const {
    return std::vector<double>(points.size(), variance());
  }
  /// Z at points, shape of `points` [-]. Safe to call from several threads at once.
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

 private:
  double variance_of(const Stencil& x, const Stencil& y) const;

  Correlation correlation_;
  double cell_;
  double variance_;
  GridAxis x_, y_;
  std::size_t lags_x_, lags_y_;       ///< lags that a cell holds
  std::vector<double> correlations_;  ///< at these lags, x fastest
  PeriodicField periodic_;
};

}  // namespace talus

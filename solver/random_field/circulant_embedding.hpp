#pragma once
// Gaussian field with its full variance on a grid: circulant embedding (Dietrich & Newsam 1997), axis by axis.
//
// The grid depends on the correlation lengths and the domain alone, so a realization is the same field at every
// particle spacing. A point takes the value of the nearest node, a cell the mean over the cell of that piecewise
// constant field, scaled to the variance that the mean of the exact field has: the variance is exact everywhere.

#include <cstddef>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/field_grid.hpp"
#include "random_field/field_spec.hpp"

namespace talus {

/// Covariance of a field along one axis; that of two axes is the product of two of these.
/// C(d) = exp(-|d| / ell), or the covariance of that field's moving average over `cell`:
/// C(d) = (1/h^2) integral_{-h}^{h} (h - |s|) exp(-|d + s| / ell) ds with h = cell (Vanmarcke 1983).
struct ExponentialCovariance {
  double ell;         ///< correlation length [m], > 0
  double cell = 0.0;  ///< length that the field is averaged over [m]; 0: the field at a point

  /// @param d  lag [m]
  double operator()(double d) const;
};

/// A stationary field on equally spaced nodes of one axis, as the leading part of a periodic field: its covariance
/// matrix is a block of a circulant one, whose symmetric square root the FFT applies.
class CirculantAxis {
 public:
  /// @param lo, hi      ends of the axis [m]; the nodes reach from `lo` to `hi` or a part of a spacing beyond
  /// @param spacing     distance of nodes [m]
  /// @param covariance  its `cell` is what stencil() averages over
  CirculantAxis(double lo, double hi, double spacing, const ExponentialCovariance& covariance);
  /// The axis along which the field does not vary: one node, variance 1.
  static CirculantAxis constant() { return {}; }

  std::size_t nodes() const { return axis_.nodes(); }
  std::size_t period() const { return root_.size(); }  ///< nodes of the periodic field
  double variance() const { return variance_; }        ///< of the values that stencil() weights [-]

  /// What one row of white noise (period() numbers) becomes: period() values with the covariance of the axis.
  void filter(std::span<double> row) const;

  /// The mean over the cell around `x`, or the nearest node without a cell; beyond the ends the value of the last node
  /// holds.
  /// @param x  coordinate [m]
  Stencil stencil(double x) const;

 private:
  CirculantAxis() = default;
  double variance_of(const Stencil& stencil) const;

  GridAxis axis_;
  double cell_ = 0.0;                 ///< length that values are averaged over [m]; 0: values at points
  double variance_ = 1.0;             ///< exact variance of such values [-]
  double correlation_ = 1.0;          ///< of neighbouring nodes [-]
  std::vector<double> root_ = {1.0};  ///< square roots of the eigenvalues
};

/// Sampler of the field with covariance exp(-|dx|/ell_x - |dy|/ell_y) on a grid.
///
/// The variance is exact at every point. With r = spacing/ell along an axis, the covariance of two points is that of
/// their nodes, whose lag differs from theirs by less than one spacing; averaged over all positions of the grid it is
/// the linear interpolation of the exact one, whose relative error is below r^2/8 (0.13 % with the default r = 0.1).
/// along that axis. Bilinear interpolation, scaled to the exact variance, has a covariance too large by up to r/3.
class CirculantEmbedding {
 public:
  /// @param spec    what is asked for; its ranges have been checked
  /// @param domain  rectangle that the grid covers [m]; points outside the grid take the value at its nearest node
  /// @param dx      side of the cells that `spec.cell_average` averages over [m]; the grid does not depend on it
  /// @throws ConfigError (/random_field/grid_spacing_m) when the grid is too large
  CirculantEmbedding(const FieldSpec& spec, Box domain, double dx);

  /// Number of coefficients: white noise on the whole periodic grid.
  std::size_t terms() const { return x_.period() * y_.period(); }
  double captured_variance() const { return 1.0; }
  /// Variance of Z [-]: 1, less what averaging over cells takes away.
  double variance() const { return x_.variance() * y_.variance(); }
  /// Variance of Z at points [-], shape of `points`: the same everywhere.
  std::vector<double> variance(std::span<const Vec2> points) const {
    return std::vector<double>(points.size(), variance());
  }
  /// Z at points, shape of `points` [-].
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

 private:
  std::vector<double> grid(std::span<const double> xi) const;

  CirculantAxis x_, y_;
};

}  // namespace talus

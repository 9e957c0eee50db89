#pragma once
// Gaussian field with its full variance on a grid: circulant embedding (Dietrich & Newsam 1997), axis by axis.

#include <cstddef>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/field_spec.hpp"

namespace talus {

/// More coefficients than this are refused (160 MB of them).
inline constexpr double max_grid = 2e7;

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
  /// @param lo, hi   ends of the axis [m]; the nodes reach from `lo` to `hi` or a part of a spacing beyond
  /// @param spacing  distance of nodes [m]
  /// @throws ConfigError (/random_field/grid_spacing_m) when no padding makes the circulant matrix nonnegative definite
  CirculantAxis(double lo, double hi, double spacing, const ExponentialCovariance& covariance);
  /// The axis along which the field does not vary: one node, variance 1.
  static CirculantAxis constant() { return {}; }

  std::size_t nodes() const { return nodes_; }
  std::size_t period() const { return root_.size(); }  ///< nodes of the periodic field
  double variance() const { return variance_; }        ///< C(0) [-]

  /// What one row of white noise (period() numbers) becomes: period() values with the covariance of the axis.
  void filter(std::span<double> row) const;

  /// Linear interpolation between two nodes.
  struct Stencil {
    std::size_t left = 0, right = 0;
    double left_weight = 1, right_weight = 0;
  };
  /// @param x  coordinate [m]; one beyond the last node is taken there
  Stencil stencil(double x) const;

 private:
  CirculantAxis() = default;
  double lo_ = 0.0;
  double spacing_ = 1.0;
  double variance_ = 1.0;
  std::size_t nodes_ = 1;
  std::vector<double> root_ = {1.0};  ///< square roots of the eigenvalues
};

/// Sampler of the field with covariance exp(-|dx|/ell_x - |dy|/ell_y) on a grid, interpolated to points.
///
/// On nodes the covariance is exact, and the particles of a slide lie on nodes unless `spec.grid_spacing` says
/// otherwise. Elsewhere bilinear interpolation loses variance: with r = exp(-spacing/ell) along either axis the
/// variance is (1+r)/2 in the middle between two nodes and (2+r)/3 on average. At a spacing of ell/4 a two-dimensional
/// field loses 21 % in the middle of a cell, 14 % on average; averages over a few cells hardly change.
class CirculantEmbedding {
 public:
  /// @param spec    what is asked for; its ranges have been checked
  /// @param domain  rectangle that the grid covers [m]; points outside the grid take the value at its nearest point
  /// @param dx      particle spacing [m]: side of the cells of `cell_average`, twice the largest default grid spacing
  /// @param anchor  a point that is a node, inside the domain or not [m]; particles stand at whole halves of dx from it
  /// @throws ConfigError (/random_field/grid_spacing_m) when the grid is too large or the embedding is impossible
  CirculantEmbedding(const FieldSpec& spec, Box domain, double dx, Vec2 anchor);

  /// Number of coefficients: white noise on the whole periodic grid.
  std::size_t terms() const { return x_.period() * y_.period(); }
  double captured_variance() const { return 1.0; }
  /// Variance of Z on nodes [-]: 1, less what averaging over cells takes away.
  double variance() const { return x_.variance() * y_.variance(); }
  /// Z at points, shape of `points` [-].
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

 private:
  std::vector<double> grid(std::span<const double> xi) const;

  CirculantAxis x_, y_;
};

}  // namespace talus

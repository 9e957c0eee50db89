#pragma once
// Truncated Karhunen-Loeve expansion for covariances without closed modes: the leading eigenvectors of the covariance
// on a fixed grid, by randomised subspace iteration (Halko, Martinsson & Tropp 2011) with products by the FFT.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/field_grid.hpp"
#include "random_field/field_spec.hpp"

namespace talus {

/// More modes than this are refused; circulant embedding truncates nothing.
inline constexpr std::size_t max_grid_modes = 500;

/// A standard Gaussian field on a rectangle, x and y being the axes of the bedding: Z(x) = sum_k xi_k f_k(x), with f_k
/// bilinear between the nodes of a grid that depends on the domain and the covariance alone. On the grid the f_k are
/// orthogonal, and the field is the projection of the whole one on them; they come in order of falling share.
class GridExpansion {
 public:
  /// @param spec    what is asked for; its ranges have been checked
  /// @param domain  where the modes are solved [m]
  /// @param dx      side of the cells that `spec.cell_average` averages over [m]
  /// @throws ConfigError (/random_field/terms or /random_field/variance_share) when it takes too many modes
  GridExpansion(const FieldSpec& spec, Box domain, double dx);

  /// The same modes without averaging over cells.
  GridExpansion at_points() const;

  /// Number of modes: at most `spec.terms`; fewer where the grid has fewer nodes.
  std::size_t terms() const { return shares_.size(); }
  /// Share of the variance that the modes carry, averaged over the grid [-].
  double captured_variance() const;
  /// Variance of Z, averaged over the domain [-]: a little less, because values between nodes are interpolated.
  double variance() const { return variance_; }
  /// Share of the variance of each mode, falling [-].
  const std::vector<double>& shares() const { return shares_; }
  /// Variance of Z at points [-], shape of `points`.
  std::vector<double> variance(std::span<const Vec2> points) const;
  /// Z at points, shape of `points` [-]. The value at a point depends on that point and xi alone.
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;
  /// f_k at one point, for every k.
  std::vector<double> modes_at(Vec2 point) const;

 private:
  double mean_variance() const;
  Stencil along(const GridAxis& axis, double x) const { return cell_ > 0 ? axis.stencil(x, cell_) : axis.linear(x); }

  double cell_;
  GridAxis x_, y_;
  Eigen::MatrixXd modes_;  ///< f_k on the nodes, x fastest; a column per mode
  std::vector<double> shares_;
  double variance_ = 0.0;
};

}  // namespace talus

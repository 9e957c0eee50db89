#pragma once
// The grids of circulant embedding. A grid depends on the correlation lengths and the domain, never on the particle
// spacing, so that a realization is the same field at every particle spacing.

#include <cstddef>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/field_spec.hpp"

namespace talus {

/// More coefficients than this are refused (160 MB of them), before each axis is lengthened for the FFT.
inline constexpr double max_grid = 2e7;
/// Default distance of nodes along an axis, as a fraction of the correlation length along it.
inline constexpr double grid_fraction = 0.1;

/// The smallest 4 * 2^a 3^b 5^c that is at least n: a length that the FFT is fast at.
std::size_t fast_length(std::size_t n);

/// Distance of nodes along an axis with the correlation length `ell` [m].
double grid_spacing(const FieldSpec& spec, double ell);

/// Refuses a domain that takes too many coefficients: twice as many as intervals along each axis.
/// @throws ConfigError (/random_field/grid_spacing_m) with a spacing that fits
void check_grid_size(const FieldSpec& spec, Box domain);

/// Weights of consecutive nodes.
struct Stencil {
  std::size_t first = 0;
  std::vector<double> weights = {1.0};
};

/// Equally spaced nodes of one axis.
class GridAxis {
 public:
  /// The axis along which the field does not vary: one node.
  GridAxis() = default;
  /// @param lo, hi   ends of the axis [m]; the nodes reach from `lo` to `hi` or a part of a spacing beyond
  /// @param spacing  distance of nodes [m]
  GridAxis(double lo, double hi, double spacing);

  /// `count` nodes in the middles of equal parts of [lo, hi].
  static GridAxis middles(double lo, double hi, std::size_t count);

  std::size_t nodes() const { return nodes_; }
  double at(std::size_t node) const { return lo_ + static_cast<double>(node) * spacing_; }  ///< [m]
  double spacing() const { return spacing_; }
  /// Beyond the ends the last node. A point halfway between two nodes takes the upper one.
  std::size_t nearest_node(double x) const;
  /// Weights of the mean over [x - cell/2, x + cell/2] of the function that is constant around each node; beyond the
  /// ends the value of the last node holds. Without a cell the nearest node.
  Stencil stencil(double x, double cell) const;
  /// Weights of linear interpolation; linear for half a spacing beyond the ends, constant from there on.
  Stencil linear(double x) const;

 private:
  double lo_ = 0.0;
  double spacing_ = 1.0;
  std::size_t nodes_ = 1;
};

}  // namespace talus

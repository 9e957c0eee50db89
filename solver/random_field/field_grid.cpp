#include "random_field/field_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/error.hpp"

namespace talus {
namespace {

// Parts of a spacing that count as rounding: a point halfway between two nodes, to this tolerance, takes the upper one.
constexpr double rounding = 1e-6;

double whole_intervals(double length, double spacing) { return std::max(1.0, std::ceil(length / spacing - rounding)); }

/// The spacing u^-1 from which on (x u + 1) (y u + 1) nodes are at most n, for a domain of x by y.
double spacing_that_fits(double x, double y, double n) {
  const double b = x + y;
  return (b + std::sqrt(b * b + 4 * x * y * (n - 1))) / (2 * (n - 1));
}

}  // namespace

std::size_t fast_length(std::size_t n) {
  for (std::size_t m = (n + 3) / 4;; ++m) {
    std::size_t rest = std::max<std::size_t>(m, 1);
    for (std::size_t prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return 4 * std::max<std::size_t>(m, 1);
  }
}

double grid_spacing(const FieldSpec& spec, double ell) { return spec.grid_spacing.value_or(grid_fraction * ell); }

void check_grid_size(const FieldSpec& spec, Box domain) {
  const double x = spec.along_x() ? domain.width() : 0.0, y = spec.along_y() ? domain.height() : 0.0;
  const double along_x = spec.along_x() ? 2 * whole_intervals(x, grid_spacing(spec, spec.ell_x)) : 1.0;
  const double along_y = spec.along_y() ? 2 * whole_intervals(y, grid_spacing(spec, spec.ell_y)) : 1.0;
  if (along_x * along_y <= max_grid) return;
  const double fits = spacing_that_fits(x, y, max_grid / (spec.direction == FieldDirection::xy ? 4 : 2));
  std::ostringstream text;
  text.precision(2);
  text << (spec.grid_spacing ? "" : "is missing, and the default, a tenth of the correlation length, ") << "makes "
       << along_x * along_y << " coefficients, more than " << max_grid << "; a spacing from " << 1.05 * fits
       << " m on fits";
  throw ConfigError("/random_field/grid_spacing_m", text.str());
}

GridAxis::GridAxis(double lo, double hi, double spacing)
    : lo_(lo), spacing_(spacing), nodes_(static_cast<std::size_t>(whole_intervals(hi - lo, spacing)) + 1) {}

GridAxis GridAxis::middles(double lo, double hi, std::size_t count) {
  GridAxis axis;
  axis.spacing_ = (hi - lo) / static_cast<double>(count);
  axis.lo_ = lo + axis.spacing_ / 2;
  axis.nodes_ = count;
  return axis;
}

std::size_t GridAxis::nearest_node(double x) const {
  const double position = std::floor((x - lo_) / spacing_ + 0.5 + rounding);
  return static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(nodes_ - 1)));
}

Stencil GridAxis::stencil(double x, double cell) const {
  if (nodes_ == 1) return {};
  if (cell == 0) return {nearest_node(x), {1.0}};
  const double lo = x - cell / 2, hi = x + cell / 2;
  const std::size_t first = nearest_node(lo), last = nearest_node(hi);
  Stencil stencil{first, std::vector<double>(last - first + 1)};
  double from = lo;
  for (std::size_t k = first; k <= last; ++k) {
    const double to = k == last ? hi : lo_ + (static_cast<double>(k) + 0.5) * spacing_;
    stencil.weights[k - first] = (to - from) / cell;
    from = to;
  }
  return stencil;
}

Stencil GridAxis::linear(double x) const {
  if (nodes_ == 1) return {};
  const double last = static_cast<double>(nodes_ - 1);
  const double position = std::clamp((x - lo_) / spacing_, -0.5, last + 0.5);
  const double first = std::clamp(std::floor(position), 0.0, last - 1);
  return {static_cast<std::size_t>(first), {1 - (position - first), position - first}};
}

}  // namespace talus

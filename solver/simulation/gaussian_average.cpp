#include "simulation/gaussian_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace talus {
namespace {

constexpr double cells_per_sigma = 2.0;
constexpr double most_cells = 4e6;  ///< soil that is scattered over a large terrain gets a coarser grid
constexpr double reach = 3.5;       ///< of the kernel [sigma]

/// A grid over all points, and room for the kernel around them.
struct Grid {
  double left, bottom, cell;  ///< [m]
  std::size_t columns, rows;
  std::vector<double> weight, product;  ///< sums over the points, by node

  /// Calls f(node, share) for the four nodes around a point.
  template <class F>
  void for_nodes(double x, double y, F&& f) const {
    const double u = (x - left) / cell, v = (y - bottom) / cell;
    const auto i = static_cast<std::size_t>(u), j = static_cast<std::size_t>(v);
    const double a = u - static_cast<double>(i), b = v - static_cast<double>(j);
    const std::size_t node = j * columns + i;
    f(node, (1.0 - a) * (1.0 - b));
    f(node + 1, a * (1.0 - b));
    f(node + columns, (1.0 - a) * b);
    f(node + columns + 1, a * b);
  }
};

Grid grid_over(std::span<const double> x, std::span<const double> y, double sigma) {
  const auto [left, right] = std::ranges::minmax(x);
  const auto [bottom, top] = std::ranges::minmax(y);
  const double margin = reach * sigma, width = right - left + 2.0 * margin, height = top - bottom + 2.0 * margin;
  const double cell = std::max(sigma / cells_per_sigma, std::sqrt(width * height / most_cells));
  Grid grid{left - margin,
            bottom - margin,
            cell,
            static_cast<std::size_t>(width / cell) + 2,
            static_cast<std::size_t>(height / cell) + 2,
            {},
            {}};
  grid.weight.assign(grid.columns * grid.rows, 0.0);
  grid.product.assign(grid.columns * grid.rows, 0.0);
  return grid;
}

/// Weights of a Gaussian at the nodes 0, 1, 2 ... to one side. Spreading a point over the nodes and reading between
/// them each widen it by cell^2/6 along an axis.
std::vector<double> taps(double sigma, double cell) {
  const double variance = std::max(sigma * sigma - cell * cell / 3.0, 0.25 * cell * cell);
  std::vector<double> weights;
  for (std::size_t k = 0; static_cast<double>(k) * cell <= reach * sigma; ++k)
    weights.push_back(std::exp(-0.5 * std::pow(static_cast<double>(k) * cell, 2) / variance));
  return weights;
}

/// Convolves along one axis. @param count  nodes along it, `stride` apart; @param lines  their number, `step` apart
void convolve(std::vector<double>& values, std::span<const double> taps, std::size_t count, std::size_t stride,
              std::size_t lines, std::size_t step) {
  std::vector<double> line(count);
  for (std::size_t l = 0; l < lines; ++l) {
    double* at = values.data() + l * step;
    for (std::size_t k = 0; k < count; ++k) line[k] = at[k * stride];
    if (std::ranges::all_of(line, [](double v) { return v == 0.0; })) continue;
    for (std::size_t k = 0; k < count; ++k) {
      double sum = taps[0] * line[k];
      for (std::size_t d = 1; d < taps.size(); ++d) {
        if (k >= d) sum += taps[d] * line[k - d];
        if (k + d < count) sum += taps[d] * line[k + d];
      }
      at[k * stride] = sum;
    }
  }
}

}  // namespace

std::vector<double> gaussian_average(std::span<const double> x, std::span<const double> y,
                                     std::span<const double> weight, std::span<const double> value, double sigma) {
  std::vector<double> average(x.size(), 0.0);
  if (x.empty()) return average;
  Grid grid = grid_over(x, y, sigma);
  for (std::size_t i = 0; i < x.size(); ++i)
    grid.for_nodes(x[i], y[i], [&](std::size_t node, double share) {
      grid.weight[node] += share * weight[i];
      grid.product[node] += share * weight[i] * value[i];
    });
  const std::vector<double> kernel = taps(sigma, grid.cell);
  for (std::vector<double>* sums : {&grid.weight, &grid.product}) {
    convolve(*sums, kernel, grid.columns, 1, grid.rows, grid.columns);
    convolve(*sums, kernel, grid.rows, grid.columns, grid.columns, 1);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    double sum = 0.0, product = 0.0;
    grid.for_nodes(x[i], y[i], [&](std::size_t node, double share) {
      sum += share * grid.weight[node];
      product += share * grid.product[node];
    });
    average[i] = product / sum;
  }
  return average;
}

}  // namespace talus

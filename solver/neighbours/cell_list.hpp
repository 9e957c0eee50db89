#pragma once
// Linked-list cells (Hockney & Eastwood 1988) over points stored in cell order, so that the candidates around a point
// are a few contiguous index ranges.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// Cells a reach high and a quarter of it wide: a search visits three rows, each one contiguous range of indices in
/// which the points stand almost in order of x. Long ranges suit vectors, narrow cells keep them from carrying much
/// that is too far.
class CellList {
 public:
  /// Sorts points into cells and remembers the order.
  /// @param x,y    coordinates [m]
  /// @param reach  largest distance that will be searched [m], > 0
  /// The order is stable: points of one cell keep their sequence.
  template <class Real>
  void build(std::span<const Real> x, std::span<const Real> y, double reach);
  void build(const std::vector<double>& x, const std::vector<double>& y, double reach) {
    build(std::span(x), std::span(y), reach);
  }

  /// order()[k] = index before sorting of the point that must stand at index k. Apply it before searching.
  std::span<const std::uint32_t> order() const { return order_; }

  /// Calls visit(begin, end) for the ranges of indices that may lie within `reach` of `point`, bottom row first.
  template <class Visit>
  void for_ranges(Vec2 point, Visit&& visit) const {
    const std::int64_t x = column(point.x), y = row(point.y);
    visit_cells(std::max<std::int64_t>(x - across, 0), std::min(x + across, columns_ - 1),
                std::max<std::int64_t>(y - 1, 0), std::min(y + 1, rows_ - 1), visit);
  }
  /// Calls visit(begin, end) for the ranges of indices that cover `region` [m].
  template <class Visit>
  void for_ranges(Box region, Visit&& visit) const {
    visit_cells(column(region.lo.x), column(region.hi.x), row(region.lo.y), row(region.hi.y), visit);
  }

  /// Rows of cells; indices of one row are contiguous.
  std::size_t rows() const { return static_cast<std::size_t>(rows_); }
  /// First index of row r; row_begin(rows()) is the number of points.
  std::uint32_t row_begin(std::size_t r) const { return starts_[r * static_cast<std::size_t>(columns_)]; }

  /// Smallest box around the points of the last build [m].
  Box box() const { return box_; }

 private:
  static constexpr std::int64_t across = 4;  ///< cells to a reach along x

  template <class Visit>
  void visit_cells(std::int64_t x0, std::int64_t x1, std::int64_t y0, std::int64_t y1, Visit&& visit) const {
    for (std::int64_t r = y0; r <= y1; ++r) {
      const std::uint32_t begin = starts_[static_cast<std::size_t>(r * columns_ + x0)];
      const std::uint32_t end = starts_[static_cast<std::size_t>(r * columns_ + x1 + 1)];
      if (begin != end) visit(begin, end);
    }
  }

  // Clamped to the grid: points outside it fall into the border cells, which keeps every search right.
  std::int64_t column(double x) const { return clamp((x - box_.lo.x) * across * inverse_reach_, columns_); }
  std::int64_t row(double y) const { return clamp((y - box_.lo.y) * inverse_reach_, rows_); }
  static std::int64_t clamp(double c, std::int64_t n) {
    return c > 0.0 ? (c < static_cast<double>(n) ? static_cast<std::int64_t>(c) : n - 1) : 0;
  }

  Box box_;
  double inverse_reach_ = 1.0;
  std::int64_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> starts_ = {0, 0};  ///< first index of each cell, row by row; one more at the end
  std::vector<std::uint32_t> order_;
};

/// The cells of the two kinds of particles.
struct ParticleCells {
  CellList soil, walls;
};

/// values[k] <- values[order[k]], through scratch memory that arrays of every kind share and that is kept.
template <class T>
void permute(std::vector<T>& values, std::span<const std::uint32_t> order, std::vector<double>& scratch) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(double));
  if (order.empty()) return;
  scratch.resize(std::max(scratch.size(), order.size()));
  auto* bytes = reinterpret_cast<std::byte*>(scratch.data());
  for (std::size_t k = 0; k < order.size(); ++k) std::memcpy(bytes + k * sizeof(T), &values[order[k]], sizeof(T));
  std::memcpy(values.data(), bytes, order.size() * sizeof(T));
}

}  // namespace talus

#pragma once
// Linked-list cells (Hockney & Eastwood 1988) over points stored in cell order, so that the candidates around a place are a
// few contiguous index ranges.

#include <cstdint>
#include <span>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// Cells of half a reach: a search visits 5 rows of 5 cells, each row one contiguous range.
class CellList {
 public:
  /// Sorts points into cells and remembers the order.
  /// @param x,y    coordinates [m]
  /// @param reach  largest distance that will be searched [m], > 0
  /// The order is stable: points of one cell keep their sequence.
  void build(std::span<const double> x, std::span<const double> y, double reach);

  /// order()[k] = index before sorting of the point that must stand at place k. Apply it before searching.
  std::span<const std::uint32_t> order() const { return order_; }

  /// Calls visit(begin, end) for each contiguous range of places that may lie within `reach` of `point`, bottom row first.
  template <class Visit>
  void for_ranges(Vec2 point, Visit&& visit) const {
    const std::int64_t cx = column(point.x), cy = row(point.y);
    const std::int64_t x0 = cx > 2 ? cx - 2 : 0, x1 = cx + 2 < columns_ ? cx + 2 : columns_ - 1;
    const std::int64_t y0 = cy > 2 ? cy - 2 : 0, y1 = cy + 2 < rows_ ? cy + 2 : rows_ - 1;
    for (std::int64_t r = y0; r <= y1; ++r) {
      const std::uint32_t begin = starts_[static_cast<std::size_t>(r * columns_ + x0)];
      const std::uint32_t end = starts_[static_cast<std::size_t>(r * columns_ + x1 + 1)];
      if (begin != end) visit(begin, end);
    }
  }

 private:
  // Clamped to the grid: points outside it fall into the border cells, which keeps every search right.
  std::int64_t column(double x) const { return clamp((x - lo_.x) * inverse_cell_, columns_); }
  std::int64_t row(double y) const { return clamp((y - lo_.y) * inverse_cell_, rows_); }
  static std::int64_t clamp(double c, std::int64_t n) {
    return c > 0.0 ? (c < static_cast<double>(n) ? static_cast<std::int64_t>(c) : n - 1) : 0;
  }

  Vec2 lo_;
  double inverse_cell_ = 1.0;
  std::int64_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> starts_ = {0, 0};  ///< first place of each cell, row by row; one more at the end
  std::vector<std::uint32_t> order_, cell_of_;
};

/// values[k] <- values[order[k]], through a scratch vector that keeps its memory.
template <class T>
void permute(std::vector<T>& values, std::span<const std::uint32_t> order, std::vector<T>& scratch) {
  scratch.resize(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) scratch[k] = values[order[k]];
  for (std::size_t k = order.size(); k < values.size(); ++k) scratch[k] = values[k];
  values.swap(scratch);
}

}  // namespace talus

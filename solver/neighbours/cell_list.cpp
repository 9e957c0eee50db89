#include "neighbours/cell_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace talus {

namespace {
// A stray particle far away must not blow the grid up: beyond this size the grid stops and the rest is clamped into its
// border.
constexpr std::int64_t max_cells = 1 << 22, max_rows = 1 << 11;
}  // namespace

template <class Real>
void CellList::build(std::span<const Real> x, std::span<const Real> y, double reach) {
  const std::size_t n = x.size();
  inverse_reach_ = 1.0 / reach;
  order_.resize(n);
  if (n == 0) {
    box_ = {};
    columns_ = rows_ = 1;
    starts_.assign(2, 0);
    return;
  }
  const auto [x_lo, x_hi] = std::minmax_element(x.begin(), x.end());
  const auto [y_lo, y_hi] = std::minmax_element(y.begin(), y.end());
  box_ = {{*x_lo, *y_lo}, {*x_hi, *y_hi}};
  const auto cells = [&](double reaches, std::int64_t most) {
    const double c = std::floor(reaches) + 1.0;
    return c < static_cast<double>(most) ? static_cast<std::int64_t>(c) : most;
  };
  rows_ = cells(box_.height() * inverse_reach_, max_rows);
  columns_ = cells(box_.width() * across * inverse_reach_, max_cells / rows_);
  starts_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  const auto cell_of = [&](std::size_t i) { return static_cast<std::size_t>(row(y[i]) * columns_ + column(x[i])); };
  for (std::size_t i = 0; i < n; ++i) ++starts_[cell_of(i) + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  // Counting sort, stable; `starts_` is used as the running cursor and shifted back afterwards.
  for (std::size_t i = 0; i < n; ++i) order_[starts_[cell_of(i)]++] = static_cast<std::uint32_t>(i);
  for (std::size_t c = starts_.size() - 1; c > 0; --c) starts_[c] = starts_[c - 1];
  starts_[0] = 0;
}

template void CellList::build(std::span<const float>, std::span<const float>, double);
template void CellList::build(std::span<const double>, std::span<const double>, double);

}  // namespace talus

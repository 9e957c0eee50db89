#include "random_field/karhunen_loeve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

AxisModes axis(double lo, double hi, double ell, bool varies, RootIntervals intervals) {
  return varies ? AxisModes(lo, hi, ell, intervals) : AxisModes::constant();
}

std::vector<ModePair> truncate(const FieldSpec& spec, AxisModes& x, AxisModes& y) {
  const auto terms = static_cast<std::size_t>(spec.terms);
  if (spec.truncation == Truncation::diagonal) return diagonal_products(x, y, terms);
  if (spec.truncation == Truncation::variance_share) return products_reaching(x, y, spec.variance_share);
  return largest_products(x, y, terms);
}

/// Points in order of x, then y, so that equal x stand together.
std::vector<std::size_t> sorted(std::span<const Vec2> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return points[i].x != points[j].x ? points[i].x < points[j].x : points[i].y < points[j].y;
  });
  return order;
}

double itself(double f) { return f; }
double squared(double f) { return f * f; }

}  // namespace

KarhunenLoeve::KarhunenLoeve(const FieldSpec& spec, Box domain, double dx)
    : x_(axis(domain.lo.x, domain.hi.x, spec.ell_x, spec.along_x(), spec.root_intervals)),
      y_(axis(domain.lo.y, domain.hi.y, spec.ell_y, spec.along_y(), spec.root_intervals)),
      pairs_(truncate(spec, x_, y_)) {
  const double cell = spec.cell_average ? dx : 0.0;
  for (const ModePair& pair : pairs_)
    scale_.push_back(std::sqrt(pair.lambda) * x_[pair.ix].averaging_factor(cell) * y_[pair.iy].averaging_factor(cell));
  build_rows();
}

// In each truncation the y modes of one x mode are consecutive: 0, 1, ... of the largest products, one of the diagonal.
void KarhunenLoeve::build_rows() {
  for (const ModePair& pair : pairs_) {
    if (pair.ix >= rows_.size()) rows_.resize(pair.ix + 1);
    Row& row = rows_[pair.ix];
    row.first = row.count == 0 ? pair.iy : std::min(row.first, pair.iy);
    ++row.count;
    y_count_ = std::max(y_count_, pair.iy + 1);
  }
  std::size_t offset = 0;
  for (Row& row : rows_) {
    row.offset = offset;
    offset += row.count;
  }
}

// f is normed to integral f^2 = 1 over the domain, so a mode contributes scale^2 / area. Averaging factors scale f as a
// whole, hence the sum of squares is exact with them too.
double KarhunenLoeve::variance() const {
  const double sum = std::inner_product(scale_.begin(), scale_.end(), scale_.begin(), 0.0);
  return sum / (x_.length() * y_.length());
}

std::vector<double> KarhunenLoeve::by_rows(const std::vector<double>& by_modes) const {
  std::vector<double> c(pairs_.size());
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Row& row = rows_[pairs_[k].ix];
    c[row.offset + pairs_[k].iy - row.first] = by_modes[k];
  }
  return c;
}

/// g_j = sum_i c_ij shape(f_i(x)): what is left of the expansion at one x, a sum over y modes.
void KarhunenLoeve::contract(double x, Shape shape, const std::vector<double>& coefficients,
                             std::vector<double>& g) const {
  g.assign(y_count_, 0.0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const double f = shape(x_.solved(i).value(x - x_.centre()));
    const double* c = coefficients.data() + row.offset;
    double* out = g.data() + row.first;
    for (std::size_t j = 0; j < row.count; ++j) out[j] += f * c[j];
  }
}

/// sum_j g_j(x) shape(f_j(y)) at the points of one chunk; functions of x and y are tabled once per distinct coordinate.
void KarhunenLoeve::evaluate(std::span<const Vec2> points, std::span<const std::size_t> chunk, Shape shape,
                             const std::vector<double>& coefficients, std::vector<double>& z) const {
  std::vector<double> ys;
  for (std::size_t i : chunk) ys.push_back(points[i].y);
  std::sort(ys.begin(), ys.end());
  ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
  std::vector<double> table(ys.size() * y_count_);
  for (std::size_t k = 0; k < ys.size(); ++k)
    for (std::size_t j = 0; j < y_count_; ++j) table[k * y_count_ + j] = shape(y_.solved(j).value(ys[k] - y_.centre()));

  std::vector<double> g;
  for (std::size_t n = 0; n < chunk.size(); ++n) {
    const Vec2 point = points[chunk[n]];
    if (n == 0 || point.x != points[chunk[n - 1]].x) contract(point.x, shape, coefficients, g);
    const auto k = static_cast<std::size_t>(std::lower_bound(ys.begin(), ys.end(), point.y) - ys.begin());
    z[chunk[n]] = std::inner_product(g.begin(), g.end(), table.data() + k * y_count_, 0.0);
  }
}

/// sum_k c_k shape(f_ix(x)) shape(f_iy(y)) at points.
std::vector<double> KarhunenLoeve::expand(std::span<const Vec2> points, Shape shape,
                                          const std::vector<double>& by_modes) const {
  constexpr std::size_t chunk_size = 1024;  // bounds the table of y functions
  const std::vector<double> c = by_rows(by_modes);
  const std::vector<std::size_t> order = sorted(points);
  std::vector<double> z(points.size());
  for (std::size_t start = 0; start < order.size(); start += chunk_size)
    evaluate(points, std::span(order).subspan(start, std::min(chunk_size, order.size() - start)), shape, c, z);
  return z;
}

std::vector<double> KarhunenLoeve::gaussian(std::span<const Vec2> points, std::span<const double> xi) const {
  std::vector<double> c(scale_);
  for (std::size_t k = 0; k < c.size(); ++k) c[k] *= xi[k];
  return expand(points, itself, c);
}

std::vector<double> KarhunenLoeve::modes_at(Vec2 point) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    values.push_back(scale_[k] * x_.solved(pairs_[k].ix).value(point.x - x_.centre()) *
                     y_.solved(pairs_[k].iy).value(point.y - y_.centre()));
  return values;
}

std::vector<double> KarhunenLoeve::variance(std::span<const Vec2> points) const {
  std::vector<double> c(scale_);
  for (double& scale : c) scale *= scale;
  return expand(points, squared, c);
}

}  // namespace talus

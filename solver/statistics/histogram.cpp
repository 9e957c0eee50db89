#include "statistics/histogram.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace talus {
namespace {

/// A step m 10^e with m in {1, 2, 5}; its multiples are formed so that 3 * 0.1 prints as 0.3.
struct RoundStep {
  int m = 1;
  int e = 0;
  double value() const { return multiple(1.0); }
  double multiple(double i) const { return e < 0 ? i * m / std::pow(10.0, -e) : i * m * std::pow(10.0, e); }
  RoundStep next() const { return m == 5 ? RoundStep{1, e + 1} : RoundStep{m == 1 ? 2 : 5, e}; }
};

/// The largest round step not above `width`, as it is meant: 0.2 stays 0.2 although 0.2 / 0.1 may round to 1.99...
RoundStep round_step(double width) {
  RoundStep step{1, static_cast<int>(std::floor(std::log10(width))) - 1};
  while (step.next().value() <= width * (1.0 + 1e-12)) step = step.next();
  return step;
}

constexpr double most_intervals = 1000.0;

}  // namespace

Histogram histogram(std::span<const double> sample, std::vector<double> edges) {
  assert(edges.size() >= 2 && std::is_sorted(edges.begin(), edges.end()));
  Histogram h{.edges = std::move(edges), .counts = {}};
  h.counts.assign(h.edges.size() - 1, 0);
  for (double x : sample) {
    if (x < h.edges.front()) {
      ++h.underflow;
    } else if (x > h.edges.back()) {
      ++h.overflow;
    } else {
      const auto above = std::upper_bound(h.edges.begin(), h.edges.end(), x) - h.edges.begin();
      ++h.counts[std::min(static_cast<std::size_t>(above), h.counts.size()) - 1];
    }
  }
  return h;
}

std::vector<double> round_grid(double lo, double hi, double width) {
  assert(lo <= hi && width > 0.0);
  // A finer grid could not be told from rounding, and its lines could not be counted.
  const double finest = 1e-12 * std::max({std::abs(lo), std::abs(hi), 1.0});
  RoundStep step = round_step(std::max(width, finest));
  while ((hi - lo) / step.value() > most_intervals) step = step.next();
  double first = std::floor(lo / step.value());
  if (step.multiple(first + 1.0) <= lo) first += 1.0;  // the quotient may fall just below an integer
  if (step.multiple(first) > lo) first -= 1.0;
  std::vector<double> grid{step.multiple(first)};
  for (double i = first + 1.0; grid.back() < hi || grid.size() < 2; i += 1.0) grid.push_back(step.multiple(i));
  return grid;
}

std::vector<double> equal_edges(std::span<const double> sorted, std::size_t bins) {
  assert(bins >= 1);
  if (sorted.empty()) return {};
  double lo = sorted.front(), hi = sorted.back();
  const double least = 1e-9 * std::max({std::abs(lo), std::abs(hi), 1.0});
  if (hi - lo < least) {
    lo -= 0.05;
    hi += 0.05;
  }
  std::vector<double> edges(bins + 1, hi);  // the last one exactly, so that the greatest value is inside
  for (std::size_t i = 0; i < bins; ++i) edges[i] = lo + (hi - lo) * static_cast<double>(i) / static_cast<double>(bins);
  return edges;
}

std::vector<double> round_edges(std::span<const double> sample) {
  const SampleMoments m = moments(sample);
  if (m.n == 0) return {};
  const double scott = m.stdev.value_or(0.0) * 3.49 / std::cbrt(static_cast<double>(m.n));
  // Below a billionth of the values themselves, what varies is rounding.
  const double least = 1e-9 * std::max(std::abs(*m.min), std::abs(*m.max));
  return round_grid(*m.min, *m.max, scott > least ? scott : 0.1);
}

Interval wilson(std::int64_t k, std::int64_t n) {
  assert(n >= 1 && k >= 0 && k <= n);
  const double z = boost::math::quantile(boost::math::complement(boost::math::normal(), 0.025));
  const auto count = static_cast<double>(n);
  const double p = static_cast<double>(k) / count;
  const double scale = 1.0 + z * z / count;
  const double centre = (p + z * z / (2.0 * count)) / scale;
  const double half = z / scale * std::sqrt(p * (1.0 - p) / count + z * z / (4.0 * count * count));
  // At the ends the bound is the end itself; rounding must not say otherwise.
  return {k == 0 ? 0.0 : std::max(0.0, centre - half), k == n ? 1.0 : std::min(1.0, centre + half)};
}

std::vector<Exceedance> exceedance(std::span<const double> sorted, std::span<const double> x, std::int64_t failed,
                                   std::span<const double> censored) {
  std::vector<Exceedance> curve;
  const auto n = static_cast<std::int64_t>(sorted.size()) + failed;
  if (n == 0) return curve;
  for (double at : x) {
    const std::int64_t seen = sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), at);
    const std::int64_t k = seen + (std::upper_bound(censored.begin(), censored.end(), at) - censored.begin());
    curve.push_back({.x = at,
                     .k = k,
                     .n = n,
                     .p = static_cast<double>(k) / static_cast<double>(n),
                     .p_if_failed_all_exceed = static_cast<double>(k + failed) / static_cast<double>(n),
                     .lo = *wilson(seen, n).lo,
                     .hi = *wilson(k + failed, n).hi});
  }
  return curve;
}

}  // namespace talus

#include "statistics/sample.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

namespace talus {
namespace {

constexpr double tail = 0.025;  // each side of a two-sided 95 % interval

/// sum (x - centre)^power
double central_sum(std::span<const double> sample, double centre, int power) {
  double sum = 0.0;
  for (double x : sample) {
    double term = x - centre;
    for (int k = 1; k < power; ++k) term *= x - centre;
    sum += term;
  }
  return sum;
}

/// Type 7: h = (n - 1) p, x[floor h] + (h - floor h) (x[floor h + 1] - x[floor h]), with 0-based x. `at(i)` may be
/// infinite.
template <class At>
double type7(std::int64_t n, double p, At at) {
  const double h = static_cast<double>(n - 1) * p;
  const auto k = std::min(static_cast<std::int64_t>(h), n - 1);
  const double fraction = h - static_cast<double>(k);
  return fraction > 0.0 ? at(k) + fraction * (at(k + 1) - at(k)) : at(k);
}

std::optional<double> finite(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

}  // namespace

SampleMoments moments(std::span<const double> sample) {
  SampleMoments m;
  m.n = static_cast<std::int64_t>(sample.size());
  if (m.n < 1) return m;
  const auto n = static_cast<double>(m.n);
  const auto [min, max] = std::minmax_element(sample.begin(), sample.end());
  m.min = *min;
  m.max = *max;
  double sum = 0.0;
  for (double x : sample) sum += x;
  // Rounding must not make a constant sample vary, nor push the mean out of it.
  const double mean = std::clamp(sum / n, *min, *max);
  m.mean = mean;
  if (m.n < 2) return m;

  const double square = central_sum(sample, mean, 2);
  const double s = std::sqrt(square / (n - 1.0));
  m.stdev = s;
  const double half =
      boost::math::quantile(boost::math::complement(boost::math::students_t(n - 1.0), tail)) * s / std::sqrt(n);
  m.mean_ci95 = Interval{mean - half, mean + half};
  const boost::math::chi_squared chi2(n - 1.0);
  m.stdev_ci95 = Interval{std::sqrt(square / boost::math::quantile(boost::math::complement(chi2, tail))),
                          std::sqrt(square / boost::math::quantile(chi2, tail))};
  if (m.n < 3 || s == 0.0) return m;
  const double variance = square / n;
  m.skewness = central_sum(sample, mean, 3) / n / std::pow(variance, 1.5);
  m.excess_kurtosis = central_sum(sample, mean, 4) / n / (variance * variance) - 3.0;
  return m;
}

Ranks quantile_ranks(std::int64_t n, double p) {
  const boost::math::binomial b(static_cast<double>(n), p);
  const auto below = [&](std::int64_t k) {
    return k <= 0 ? 0.0 : boost::math::cdf(b, static_cast<double>(k - 1));
  };                                        // P(B < k)
  const auto reach = [&](std::int64_t k) {  // P(B >= k)
    return k <= 0 ? 1.0 : k > n ? 0.0 : boost::math::cdf(boost::math::complement(b, static_cast<double>(k - 1)));
  };
  // Both tails are monotonic in k: bisect for the last rank that qualifies, and for the first.
  std::int64_t l = 0;
  for (std::int64_t high = n + 1; high - l > 1;) {
    const std::int64_t middle = (l + high) / 2;
    (below(middle) <= tail ? l : high) = middle;
  }
  std::int64_t u = n + 1;
  for (std::int64_t low = 0; u - low > 1;) {
    const std::int64_t middle = (low + u) / 2;
    (reach(middle) <= tail ? u : low) = middle;
  }
  return {l, u};
}

Quantile quantile(std::span<const double> sorted, double p, std::int64_t failed) {
  assert(!sorted.empty() && p >= 0.0 && p <= 1.0);
  constexpr double inf = std::numeric_limits<double>::infinity();
  const auto n = static_cast<std::int64_t>(sorted.size());
  const auto at = [&](std::int64_t i) { return i < 0 ? -inf : i >= n ? inf : sorted[static_cast<std::size_t>(i)]; };
  const Ranks ranks = quantile_ranks(n, p);
  return {.p = p,
          .value = type7(n, p, at),
          .ci95 = {finite(at(ranks.l - 1)), finite(at(ranks.u - 1))},
          .if_failed_below = finite(type7(n + failed, p, [&](std::int64_t i) { return at(i - failed); })),
          .if_failed_above = finite(type7(n + failed, p, at))};
}

std::optional<Ratio> stdev_ratio(const SampleMoments& numerator, const SampleMoments& denominator) {
  if (!numerator.stdev || !denominator.stdev || *denominator.stdev == 0.0) return std::nullopt;
  const double ratio = *numerator.stdev / *denominator.stdev;
  const boost::math::fisher_f f(static_cast<double>(numerator.n - 1), static_cast<double>(denominator.n - 1));
  return Ratio{ratio,
               {ratio / std::sqrt(boost::math::quantile(boost::math::complement(f, tail))),
                ratio / std::sqrt(boost::math::quantile(f, tail))}};
}

std::optional<double> correlation(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  const SampleMoments ma = moments(a);
  const SampleMoments mb = moments(b);
  if (!ma.stdev || *ma.stdev == 0.0 || *mb.stdev == 0.0) return std::nullopt;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - *ma.mean) * (b[i] - *mb.mean);
  return std::clamp(sum / (static_cast<double>(ma.n - 1) * *ma.stdev * *mb.stdev), -1.0, 1.0);
}

}  // namespace talus

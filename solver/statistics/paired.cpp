#include "statistics/paired.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <cassert>
#include <vector>

namespace talus {
namespace {

/// @param tail  of each side
Interval exact_interval(std::int64_t k, std::int64_t n, double tail) {
  if (n == 0) return {0.0, 1.0};
  const auto count = static_cast<double>(n), hits = static_cast<double>(k);
  Interval interval{0.0, 1.0};
  if (k > 0) interval.lo = boost::math::quantile(boost::math::beta_distribution<>(hits, count - hits + 1.0), tail);
  if (k < n)
    interval.hi = boost::math::quantile(
        boost::math::complement(boost::math::beta_distribution<>(hits + 1.0, count - hits), tail));
  return interval;
}

/// P(B <= k) for k successes or fewer, doubled: B ~ Binomial(m, 1/2).
double two_sided(std::int64_t fewer, std::int64_t m) {
  if (m == 0) return 1.0;
  const boost::math::binomial half(static_cast<double>(m), 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(half, static_cast<double>(fewer)));
}

}  // namespace

PairedDifference paired_difference(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(b[i] - a[i]);
  const SampleMoments of_a = moments(a), of_b = moments(b), of_d = moments(differences);
  PairedDifference d{.n = of_d.n,
                     .mean = of_d.mean,
                     .ci95 = of_d.mean_ci95,
                     .stdev = of_d.stdev,
                     .correlation = correlation(a, b),
                     .worth_runs = {}};
  if (d.stdev && *d.stdev > 0.0) {
    const double apart = *of_a.stdev * *of_a.stdev + *of_b.stdev * *of_b.stdev;
    d.worth_runs = static_cast<double>(d.n) * apart / (*d.stdev * *d.stdev);
  }
  return d;
}

Interval clopper_pearson(std::int64_t k, std::int64_t n) {
  assert(k >= 0 && k <= n);
  return exact_interval(k, n, 0.025);
}

PairedHits paired_hits(std::span<const std::pair<bool, bool>> pairs) {
  PairedHits hits{.n = static_cast<std::int64_t>(pairs.size()), .ci95 = {-1.0, 1.0}};
  for (const auto& [a, b] : pairs) {
    hits.both += a && b ? 1 : 0;
    hits.only_a += a && !b ? 1 : 0;
    hits.only_b += b && !a ? 1 : 0;
  }
  if (hits.n == 0) return hits;
  const std::int64_t m = hits.only_a + hits.only_b;
  hits.difference = static_cast<double>(hits.only_b - hits.only_a) / static_cast<double>(hits.n);
  hits.p_value = two_sided(std::min(hits.only_a, hits.only_b), m);
  constexpr double tail = 0.0125;
  const Interval discordance = exact_interval(m, hits.n, tail), share = exact_interval(hits.only_b, m, tail);
  double least = 1.0, greatest = -1.0;
  for (const double d : {*discordance.lo, *discordance.hi})
    for (const double q : {*share.lo, *share.hi}) {
      least = std::min(least, d * (2.0 * q - 1.0));
      greatest = std::max(greatest, d * (2.0 * q - 1.0));
    }
  hits.ci95 = {least, greatest};
  return hits;
}

}  // namespace talus

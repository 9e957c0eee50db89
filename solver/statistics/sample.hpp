#pragma once
// What a sample of run-outs says: moments and quantiles, each with its 95 % interval. Pure functions.
//
// Units are those of the sample. Every interval has the two-sided level 95 %. What cannot be said of so small a sample
// is unset, never NaN.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace talus {

/// A confidence interval; an unset end is unbounded.
struct Interval {
  std::optional<double> lo;
  std::optional<double> hi;
  bool operator==(const Interval&) const = default;
};

/// Moments of a sample with the intervals that hold for independent draws of a normal variable.
struct SampleMoments {
  std::int64_t n = 0;
  std::optional<double> mean;          ///< unset for n < 1
  std::optional<Interval> mean_ci95;   ///< Student: mean +/- t_{0.975, n-1} s / sqrt(n); unset for n < 2
  std::optional<double> stdev;         ///< s, with divisor n - 1; unset for n < 2
  std::optional<Interval> stdev_ci95;  ///< chi-square: s sqrt((n-1) / chi2_{n-1}); exact only for a normal variable
  std::optional<double> skewness;      ///< third standardised moment, divisor n; 0 if normal; unset for n < 3 or s = 0
  std::optional<double> excess_kurtosis;  ///< fourth standardised moment minus 3, divisor n; 0 if normal; as above
  std::optional<double> min;
  std::optional<double> max;
};

/// Moments of `sample`, in any order; sums are taken in the order given.
SampleMoments moments(std::span<const double> sample);

/// A quantile of a sample, its interval, and what failed realizations could make of it.
struct Quantile {
  double p = 0.5;      ///< probability, in [0, 1]
  double value = 0.0;  ///< type 7 of Hyndman & Fan (1996): linear between x_(k) and x_(k+1), k = 1 + (n-1) p
  Interval ci95;       ///< distribution-free, between two order statistics
  std::optional<double> if_failed_below;  ///< value if all failed ones lay below the rest; unset: among the failed
  std::optional<double> if_failed_above;  ///< value if all failed ones lay above the rest; unset: among the failed
};

/// Quantile of a sorted, non-empty sample; `failed` counts the realizations that gave no value.
Quantile quantile(std::span<const double> sorted, double p, std::int64_t failed = 0);

/// Ranks l < u (1-based) with P(x_(l) <= q_p < x_(u)) >= 0.95 for any continuous distribution; 0 and n + 1 mean that no
/// order statistic bounds that side. With B ~ Binomial(n, p): l is the largest rank with P(B < l) <= 0.025, u the
/// smallest with P(B >= u) <= 0.025. (Conover, Practical Nonparametric Statistics, 3.2.)
struct Ranks {
  std::int64_t l = 0;
  std::int64_t u = 0;
};
Ranks quantile_ranks(std::int64_t n, double p);

/// The ratio of two standard deviations s_1 / s_2 and its interval from Fisher's F; exact only for normal variables.
/// Unset where either is unset or s_2 = 0.
struct Ratio {
  double value = 0.0;
  Interval ci95;
};
std::optional<Ratio> stdev_ratio(const SampleMoments& numerator, const SampleMoments& denominator);

/// Pearson's correlation of two samples of equal size; unset for n < 2 or where one of them is constant.
std::optional<double> correlation(std::span<const double> a, std::span<const double> b);

}  // namespace talus

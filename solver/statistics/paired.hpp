#pragma once
// Two variants judged on the same draws. Pure functions.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "statistics/sample.hpp"

namespace talus {

/// Difference of two variants, B less A, over pairs of the same draw.
struct PairedDifference {
  std::int64_t n = 0;                 ///< pairs
  std::optional<double> mean;         ///< of the differences; unset for n < 1
  std::optional<Interval> ci95;       ///< Student: mean +/- t_{0.975, n-1} s_d / sqrt(n); unset for n < 2
  std::optional<double> stdev;        ///< s_d of the differences; unset for n < 2
  std::optional<double> correlation;  ///< Pearson's, of the pairs; unset for n < 2 or where one variant is constant
  /// As many runs of each variant with draws of their own would give as narrow an interval, (s_a^2 + s_b^2)/s_d^2 times
  /// n; unset for n < 2 or s_d = 0.
  std::optional<double> worth_runs;
};
/// @param a, b  of equal size, pair by pair
PairedDifference paired_difference(std::span<const double> a, std::span<const double> b);

/// Clopper and Pearson's exact 95 % interval for k of n trials; [0, 1] for n = 0.
Interval clopper_pearson(std::int64_t k, std::int64_t n);

/// Difference of two probabilities over pairs of the same draw.
struct PairedHits {
  std::int64_t n = 0;       ///< pairs
  std::int64_t both = 0;    ///< hit in A and in B
  std::int64_t only_a = 0;  ///< hit in A alone
  std::int64_t only_b = 0;  ///< hit in B alone
  double difference = 0.0;  ///< P_B - P_A = (only_b - only_a) / n
  Interval ci95;            ///< of the difference, conditional and exact (below); [-1, 1] for n = 0
  double p_value = 1.0;     ///< McNemar's exact test: two-sided binomial with probability 1/2 over the discordant pairs
};
/// Given m = only_a + only_b discordant pairs, only_b is binomial. With Clopper and Pearson's interval [q0, q1] for its
/// share q and that of the discordance, [d0, d1] for m of n, each at 97.5 % (Bonferroni), the difference d (2 q - 1)
/// lies with at least 95 % between the least and the greatest of its values at the corners: exact in the sense that it
/// never covers less. (McNemar 1947, Psychometrika 12; Clopper & Pearson 1934, Biometrika 26.)
/// @param pairs  whether A hit, whether B hit
PairedHits paired_hits(std::span<const std::pair<bool, bool>> pairs);

}  // namespace talus

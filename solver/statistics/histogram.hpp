#pragma once
// Histograms with fixed edges, and exceedance curves with Wilson bounds. Pure functions.

#include <cstdint>
#include <span>
#include <vector>

#include "statistics/sample.hpp"

namespace talus {

/// Counts of a sample between fixed edges: bin i is [edges[i], edges[i+1]), the last one includes its right edge.
struct Histogram {
  std::vector<double> edges;         ///< increasing, at least two
  std::vector<std::int64_t> counts;  ///< one less than edges
  std::int64_t underflow = 0;        ///< below the first edge
  std::int64_t overflow = 0;         ///< above the last edge
};

/// The same convention in words, for files that carry a histogram.
inline constexpr const char* histogram_convention = "[a,b), the last bin [a,b]";

/// Counts `sample` between `edges`, which increase and are at least two.
Histogram histogram(std::span<const double> sample, std::vector<double> edges);

/// Edges at multiples of 1, 2 or 5 times a power of ten that hold the whole sample; the width is near Scott's
/// 3.49 s n^(-1/3) (Biometrika 66, 1979). A constant sample gets one bin of width 0.1; an empty one gets no edges.
std::vector<double> round_edges(std::span<const double> sample);

/// The edges of `bins` >= 1 equal bins from the least to the greatest of a sorted sample; a constant sample gets bins
/// of 0.1 / `bins` around it, an empty one no edges.
std::vector<double> equal_edges(std::span<const double> sorted, std::size_t bins);

/// Multiples of the round number near `width` (at most 1000 intervals) from at or below `lo` to at or above `hi`; lo <=
/// hi, both at most 1e100 in magnitude, width > 0. A width below 1e-12 of the larger of |lo|, |hi| and 1 counts as
/// that.
std::vector<double> round_grid(double lo, double hi, double width);

/// Wilson's score interval for k successes of n >= 1 (JASA 22, 1927), 95 %.
Interval wilson(std::int64_t k, std::int64_t n);

/// A point of the exceedance curve. Failed realizations stay in the denominator; since nobody knows how far they would
/// have run, the bounds let all of them, or none, exceed.
struct Exceedance {
  double x = 0.0;
  std::int64_t k = 0;                   ///< realizations that exceed x (strictly), and censored ones
  std::int64_t n = 0;                   ///< realizations made, failed ones included
  double p = 0.0;                       ///< k / n: failed ones count as not exceeding, censored ones as exceeding
  double p_if_failed_all_exceed = 0.0;  ///< (k + failed) / n
  double lo = 0.0;                      ///< Wilson's lower bound for those of n seen to exceed x
  double hi = 0.0;                      ///< Wilson's upper bound for k + failed of n
};

/// The exceedance curve of a sorted sample at the points `x`; empty where nothing was made.
/// @param censored  those values of the sample, sorted, of which only is known that the true ones are no less: they
///                  count as exceeding every x, the lower bound only where they are seen to
std::vector<Exceedance> exceedance(std::span<const double> sorted, std::span<const double> x, std::int64_t failed,
                                   std::span<const double> censored = {});

}  // namespace talus

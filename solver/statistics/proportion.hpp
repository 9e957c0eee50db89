#pragma once
// Probabilities from counts, when some of the trials were not decided. Pure functions.

#include <cstdint>

namespace talus {

/// k of n trials succeeded; `unknown` others may have.
struct Proportion {
  std::int64_t k = 0;        ///< seen to succeed
  std::int64_t n = 0;        ///< all trials, those that failed or were not decided included
  std::int64_t unknown = 0;  ///< of those that were not seen to succeed: nobody knows
  double p = 0.0;            ///< k / n; 0 without trials
  double lo = 0.0;           ///< Wilson's 95 % lower bound for k of n
  double hi = 1.0;           ///< Wilson's 95 % upper bound for k + unknown of n
};

/// @param n  >= 0; @param k, unknown  >= 0, together at most n
Proportion proportion(std::int64_t k, std::int64_t n, std::int64_t unknown);

}  // namespace talus

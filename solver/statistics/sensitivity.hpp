#pragma once
// Which variables make a sample vary: shares of its variance from a linear regression. Pure functions.

#include <cstddef>
#include <span>
#include <vector>

#include "statistics/regression.hpp"
#include "statistics/sample.hpp"

namespace talus {

/// A share of the variance of a sample, in [0, 1], with its interval.
struct VarianceShare {
  double value = 0.0;
  Interval ci95;
};

/// The share of the variance of y that each group of independent variables of variance 1 explains: the sum of b_k^2
/// over the variables of the group, over that of all variables and the variance of the residuals (first-order index of
/// Sobol 1993 for a linear model). That the variables have the variance 1 is used, so that their own scatter in the
/// sample does not widen the interval.
/// Delete-one jackknife (Miller 1974) for the bias that b_k^2 has and for the interval, with Student's quantile; both
/// are cut to [0, 1].
/// @param of        regression of y on some of the variables
/// @param y         its n values, n - K - 1 >= 2
/// @param group_of  of each of the caller's variables, < groups
/// @return one share for each group; 0 for one of which no variable is used
std::vector<VarianceShare> variance_shares(const Regression& of, std::span<const double> y,
                                           std::span<const std::size_t> group_of, std::size_t groups);

}  // namespace talus

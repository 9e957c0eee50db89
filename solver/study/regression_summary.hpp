#pragma once
// The mean of a study by regression on what its realizations drew, and which of these numbers make it vary.
//
// The draws are not kept in the records: they follow from the seed and the index of a realization, and the ones of
// 1,000 realizations with 50 numbers each take a few milliseconds.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "statistics/controlled_mean.hpp"
#include "statistics/sensitivity.hpp"
#include "study/plan.hpp"
#include "support/json.hpp"

namespace talus {

/// One of the numbers that a realization draws.
struct DrawnNumber {
  std::size_t block = 0;  ///< index into Plan::draws
  std::uint32_t mode = 0;
};

/// No more numbers serve as regressors; fewer in samples of more than 8,000, so that the time stays linear.
inline constexpr std::size_t most_regressors = 50;
/// A smaller sample is not regressed.
inline constexpr std::size_t least_to_regress = 10;

/// The numbers that may serve as regressors for a sample of n, the most important first: the leading number of each
/// block, then the second of each, and so on.
std::vector<DrawnNumber> possible_regressors(const std::vector<DrawnNumbers>& draws, std::size_t n);

/// A quantity of a study, regressed.
struct RegressionSummary {
  std::string none_because;           ///< why there is no regression, a phrase; empty: there is one
  ControlledMean mean = {};           ///< its slopes in the unit of the quantity per standard deviation
  std::vector<DrawnNumber> numbers;   ///< of each slope
  std::vector<std::string> names;     ///< of each slope: "friction 3", "viscosity"
  std::vector<VarianceShare> shares;  ///< of the variance, by block of Plan::draws
  bool done() const { return none_because.empty(); }
};

/// @param realizations  of each value
/// @param values        of the realizations done, in order of index
/// @param is_bound      some value is a lower bound, so that the mean is one
RegressionSummary regress(const Plan& plan, std::span<const std::int64_t> realizations, std::span<const double> values,
                          bool is_bound);

/// `regression` of a quantity in study.json.
Json regression_json(const Plan& plan, const RegressionSummary& of);

}  // namespace talus

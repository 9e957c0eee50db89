#include "study/regression_summary.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/stream.hpp"

namespace talus {
namespace {

constexpr double most_work = 2e7;  // n K^2: 0.1 s

std::vector<double> column_of(std::uint64_t seed, const DrawnNumbers& block, std::uint32_t mode,
                              std::span<const std::int64_t> realizations) {
  std::vector<double> column;
  column.reserve(realizations.size());
  for (const std::int64_t index : realizations)
    column.push_back(standard_normal(seed, static_cast<std::uint64_t>(index), mode, block.key));
  return column;
}

/// Why this sample cannot be regressed; empty if it can.
std::string obstacle(const Plan& plan, std::size_t n, bool is_bound) {
  if (plan.study.sampling == Sampling::latin_hypercube) return "the draws of a Latin hypercube are not independent";
  if (plan.draws.empty()) return "the plan of this study does not say what is drawn";
  if (n < least_to_regress) return "fewer than " + std::to_string(least_to_regress) + " runs";
  if (is_bound) return "soil left the terrain, so that the mean is a lower bound";
  if (std::ranges::all_of(plan.draws, [](const DrawnNumbers& of) { return of.count == 0; }))
    return "circulant embedding has no leading coefficients";
  return {};
}

std::string name_of(const Plan& plan, const DrawnNumber& number) {
  const DrawnNumbers& block = plan.draws[number.block];
  return block.count == 1 ? block.name : block.name + " " + std::to_string(number.mode + 1);
}

Json interval_json(const Interval& of) { return {*of.lo, *of.hi}; }

}  // namespace

std::vector<DrawnNumber> possible_regressors(const std::vector<DrawnNumbers>& draws, std::size_t n) {
  const auto affordable = static_cast<std::size_t>(std::sqrt(most_work / static_cast<double>(std::max(n, 1UL))));
  const std::size_t most = std::min({n / runs_per_control, most_regressors, affordable});
  std::vector<DrawnNumber> numbers;
  for (std::uint32_t mode = 0, added = 1; added > 0 && numbers.size() < most; ++mode) {
    added = 0;
    for (std::size_t block = 0; block < draws.size() && numbers.size() < most; ++block) {
      if (mode >= draws[block].count) continue;
      numbers.push_back({block, mode});
      ++added;
    }
  }
  return numbers;
}

RegressionSummary regress(const Plan& plan, std::span<const std::int64_t> realizations, std::span<const double> values,
                          bool is_bound) {
  RegressionSummary result{.none_because = obstacle(plan, values.size(), is_bound)};
  if (!result.done()) return result;
  const std::vector<DrawnNumber> possible = possible_regressors(plan.draws, values.size());
  std::vector<std::vector<double>> columns;
  std::vector<std::size_t> block_of;
  for (const DrawnNumber& number : possible) {
    columns.push_back(column_of(plan.seed, plan.draws[number.block], number.mode, realizations));
    block_of.push_back(number.block);
  }
  const Regression best = best_regression(values, columns);
  if (best.size() == 0) {
    result.none_because = "what is drawn explains nothing of it";
    return result;
  }
  result.mean = controlled_mean(best, values);
  result.shares = variance_shares(best, values, block_of, plan.draws.size());
  for (const Slope& slope : result.mean.slopes) {
    result.numbers.push_back(possible[slope.variable]);
    result.names.push_back(name_of(plan, possible[slope.variable]));
  }
  return result;
}

Json regression_json(const Plan& plan, const RegressionSummary& of) {
  if (!of.done()) return {{"none_because", of.none_because}};
  Json slopes = Json::array(), shares = Json::array();
  for (std::size_t k = 0; k < of.mean.slopes.size(); ++k)
    slopes.push_back({{"name", of.names[k]},
                      {"property", plan.draws[of.numbers[k].block].name},
                      {"coefficient", of.numbers[k].mode},
                      {"per_stdev", of.mean.slopes[k].value},
                      {"ci95", interval_json(of.mean.slopes[k].ci95)}});
  for (std::size_t block = 0; block < plan.draws.size(); ++block)
    if (plan.draws[block].count > 0)
      shares.push_back({{"name", plan.draws[block].name},
                        {"share", of.shares[block].value},
                        {"ci95", interval_json(of.shares[block].ci95)}});
  return {{"mean", of.mean.mean},
          {"mean_ci95", interval_json(of.mean.ci95)},
          {"variance_explained", std::max(0.0, 1.0 - of.mean.residual_share)},
          {"worth_runs", of.mean.worth},
          {"shares", shares},
          {"slopes", slopes}};
}

}  // namespace talus

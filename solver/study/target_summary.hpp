#pragma once
// What a study says of its targets: how likely each is reached, and how deep, fast and strong the flow is there.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "statistics/proportion.hpp"
#include "study/plan.hpp"
#include "support/json.hpp"
#include "support/targets.hpp"

namespace talus {

/// The outcomes of all realizations at one target.
struct TargetSample {
  TargetName of;
  std::vector<TargetOutcome> outcomes;          ///< of the realizations done, in order of index
  std::int64_t failed = 0;                      ///< realizations without an outcome
  std::vector<std::int64_t> realizations = {};  ///< of the outcomes; empty: not known
};

/// P(the slide reaches the target): runs that failed, and those that ended before it was decided (TargetOutcome::open),
/// count in the denominator and in the upper bound.
Proportion reached(const TargetSample& sample);
/// P(number > x), not reached counts as 0; runs that failed or ended too early (TargetOutcome::open) with no more than
/// x count in the denominator and in the upper bound. An arrival counts by x at the latest: P(arrival <= x).
Proportion beyond(const TargetSample& sample, const TargetNumber& number, double x);

/// The class of a run at a target: the last of `classes` all of whose thresholds it reaches; unset: none, or it did not
/// arrive.
std::optional<std::size_t> hazard_class(const TargetOutcome& outcome, const std::vector<HazardClass>& classes);

/// The entry of a target in study.json.
Json target_json(const TargetSample& sample, const std::vector<HazardClass>& classes = {});
/// The number of each realization, where every one done has its final number: each reached the target, none is open.
std::vector<double> numbers_of_all(const TargetSample& sample, const TargetNumber& number);

/// What of a study a question asks for: a measure, a target, or a number of a target.
struct StudyQuantity {
  const struct Measure* measure = nullptr;
  std::optional<std::size_t> target = {};  ///< index into Plan::targets
  const TargetNumber* number = nullptr;    ///< null: whether the target is reached
};
/// "front_mass_99_m", "house", "house.peak_depth_m"; nothing where the study has no such quantity.
std::optional<StudyQuantity> find_quantity(const std::string& name, const std::vector<TargetName>& targets);
/// All names of quantities that have a distribution over x.
std::vector<std::string> quantity_names(const std::vector<TargetName>& targets);

struct MeasureSample;
/// How likely a measure is beyond x: {quantity, x, unit, k, n, p, lo, hi, failed, undecided, sentence}, with
/// exceedance() of statistics/histogram.hpp.
Json exceedance_at(const Measure& measure, const MeasureSample& sample, double x);
/// How likely a target is reached, or its number is beyond x.
/// @param number  null: whether it is reached; x is then not used
Json exceedance_at(const TargetSample& sample, const TargetNumber* number, double x);

}  // namespace talus

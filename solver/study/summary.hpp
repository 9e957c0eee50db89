#pragma once
// study.json: everything a study says, from its plan and its records alone.

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "study/estimator.hpp"
#include "study/plan.hpp"
#include "study/quality_summary.hpp"
#include "study/record.hpp"
#include "study/regression_summary.hpp"
#include "study/target_summary.hpp"
#include "support/json.hpp"
#include "support/measures.hpp"

namespace talus {

/// How the values of one measure are distributed.
struct MeasureSample {
  std::vector<double> values;  ///< of the realizations done, in order of index
  /// Those of `values`, in any order, that are lower bounds (Record::lower_bounds).
  std::vector<double> censored = {};
  std::vector<double> noise = {};  ///< of realization 0 and its replicates, in order; empty without replicates
  std::int64_t failed = 0;
  QualityCounts quality;
  bool complete = false;  ///< every realization of the study has ended
  /// Of `values`, their realizations; empty: not asked for, and the mean is the plain one.
  std::vector<std::int64_t> realizations = {};
};

/// Takes in the records of a study one by one and gives study.json (schemas/study.schema.json). Holds 8 bytes a measure
/// and realization, and the reasons of failures; the time is that of sorting each measure once.
class StudySummary {
 public:
  explicit StudySummary(const Plan& plan)
      : plan_(plan), stop_(plan.study.stop_half_width), targets_(plan.targets.size()) {}

  /// The next realization, in order of index.
  /// @return false where the study ended before it (StopRule): it is not counted
  bool add(const Record& record);
  /// The next replicate of realization 0 that measures the numerical noise.
  void add_replicate(const Record& record) { replicates_.push_back(record); }

  /// The content of study.json.
  Json json() const;
  MeasureSample sample(const Measure& measure) const;
  /// The mean of a measure by regression on what was drawn.
  RegressionSummary regression(const Measure& measure) const;
  /// @param target  index into Plan::targets
  TargetSample target_sample(std::size_t target) const;

  std::int64_t done() const { return static_cast<std::int64_t>(phi_.size()); }
  std::int64_t failed() const { return static_cast<std::int64_t>(failures_.size()); }
  std::int64_t replicates_failed() const;
  /// What study.json says of the verdicts.
  Json quality_json() const;
  /// The study ended before its planned number.
  bool stopped_early() const { return stop_.size() && *stop_.size() < plan_.study.realizations; }

 private:
  std::int64_t until() const { return stopped_early() ? *stop_.size() : plan_.study.realizations; }
  Json realizations_json() const;
  Json mean_phi_json() const;
  Json replicates_json() const;
  /// Numbers that numbers_of_all() has come with their regression, where there is one.
  Json target_entry(std::size_t target) const;

  Plan plan_;
  StopRule stop_;
  std::array<std::vector<double>, measure_table.size()> samples_;   ///< of the done ones; NaN: no value
  std::array<std::vector<double>, measure_table.size()> censored_;  ///< of samples_, the lower bounds
  std::vector<std::vector<TargetOutcome>> targets_;                 ///< by target, of the done ones, in order of index
  std::vector<std::int64_t> indices_;                               ///< of the done ones, in order
  std::vector<double> phi_;                                         ///< mean friction angles [deg]
  QualitySummary quality_;
  Json failures_ = Json::array();
  Json missing_ = Json::array();  ///< ranges of indices without a record, up to next_
  std::int64_t next_ = 0;         ///< one more than the last index
  double wall_clock_ = 0.0;       ///< [s]
  std::int64_t steps_ = 0;
  std::optional<double> captured_variance_, front_thickness_;           ///< of the first realization that has them
  std::optional<std::pair<std::int64_t, double>> shortest_, farthest_;  ///< index and influence zone [m]
  std::optional<Record> origin_;  ///< realization 0: itself a replicate, the one with k = 0
  std::vector<Record> replicates_;
};

/// The summary of records in memory. A pure function: a study and `talus stats` on its tables give the same.
/// @param runs   in order of index; at most one per realization
/// @param floor  replicates of realization 0 that differ by rounding-size changes only, in order
StudySummary summary_of(const Plan& plan, const std::vector<Record>& runs, const std::vector<Record>& floor);

/// The regression of a sample that knows its realizations.
RegressionSummary regress(const Plan& plan, const MeasureSample& sample);

/// The bins to count in: given edges, so many equal bins, or, with neither, those of study.json.
struct Bins {
  std::size_t count = 0;      ///< 0: not asked for
  std::vector<double> edges;  ///< [m], increasing
};

/// What `talus stats --quantity` prints and the histogram of talusd answers.
Json distribution(const Plan& plan, const Measure& measure, const MeasureSample& sample, const Bins& bins);

}  // namespace talus

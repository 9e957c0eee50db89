#pragma once
// What a study runs next, and when it may or must end: plain Monte Carlo with replicates for the numerical noise.
//
// Both front ends and both stores use it, so there is one order of runs, one failure rule and one early stop.

#include <cstdint>
#include <map>
#include <optional>

#include "study/plan.hpp"
#include "study/run_key.hpp"

namespace talus {

/// The run at a place in the order of a study: realization 0, the replicates, then the other realizations.
/// @param replicates  of the study
RunKey run_of_rank(std::int64_t rank, std::int64_t replicates);

/// The one failure rule: more than `max_failed_share` of the planned realizations have failed, which no later run can
/// change; or all have ended and none is done.
bool too_many_failed(std::int64_t failed, std::int64_t done, std::int64_t planned, double max_failed_share);

/// A mean that grows value by value (Welford 1962).
struct RunningMean {
  std::int64_t n = 0;
  double mean = 0.0, square = 0.0;  ///< `square`: sum of squared deviations
  void add(double x);
  /// Of the 95 % interval of the mean, t_{0.975, n-1} s / sqrt(n); unset for n < 2.
  std::optional<double> half_width() const;
};

/// A study with fewer realizations done never stops early.
inline constexpr std::int64_t least_to_stop = 10;

/// Finds the smallest n such that the realizations 0..n-1 are all recorded, at least `least_to_stop` of them done, and
/// the 95 % half width of their mean influence zone is at most a given one. The study is then cut to 0..n-1. Because
/// the first suitable n is taken, the interval covers slightly less than 95 %.
class StopRule {
 public:
  /// @param half_width  StudySpec::stop_half_width [m]; unset: a study never stops early
  explicit StopRule(std::optional<double> half_width) : half_width_(half_width) {}

  /// Takes in the next realization, in order of index; a gap ends the search.
  /// @param influence_zone  [m]; unset: it failed
  void add(std::int64_t index, std::optional<double> influence_zone);
  /// n, once it is known.
  std::optional<std::int64_t> size() const { return size_; }

 private:
  std::optional<double> half_width_;
  std::int64_t next_ = 0;  ///< index that continues the prefix
  RunningMean zones_;
  std::optional<std::int64_t> size_;
};

/// One study under way. Not thread-safe.
class Estimator {
 public:
  enum class Decision { go_on, enough, too_many_failed };

  /// @param first, end  the realizations first <= i < end that are run here
  Estimator(const StudySpec& spec, std::int64_t first, std::int64_t end);

  /// A run has been recorded. @param influence_zone  [m]; unset: it failed
  void add(const RunKey& key, std::optional<double> influence_zone);
  Decision decision() const;
  /// Whether no recorded realization went farther; of equals, the one with the least index counts.
  bool is_farthest(std::int64_t index, double influence_zone) const;

  std::int64_t planned() const { return end_ - first_; }
  std::int64_t done() const { return zones_.n; }
  std::int64_t failed() const { return failed_; }
  std::int64_t replicates_made() const { return replicates_; }
  /// Of the influence zone over what is done; unset while there are too few [m].
  std::optional<double> mean() const { return zones_.n > 0 ? std::optional(zones_.mean) : std::nullopt; }
  std::optional<double> mean_half_width() const { return zones_.half_width(); }

 private:
  double max_failed_share_;
  std::int64_t realizations_, first_, end_;
  std::int64_t failed_ = 0, replicates_ = 0;
  RunningMean zones_;  ///< influence zones of the done ones [m]
  std::int64_t farthest_index_ = -1;
  double farthest_ = 0.0;
  StopRule stop_;
  std::map<std::int64_t, std::optional<double>> ahead_;  ///< influence zones beyond the first gap in the indices
  std::int64_t next_ = 0;                                ///< the first gap
};

}  // namespace talus

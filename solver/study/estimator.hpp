#pragma once
// What a study runs next, and when it may or must end: plain Monte Carlo with replicates for the numerical noise.
//
// Both front ends and both stores use it, so there is one order of runs, one failure rule and one early stop.

#include <cstdint>
#include <map>
#include <optional>

#include "study/run_key.hpp"
#include "study/spec.hpp"
#include "study/stop_rule.hpp"

namespace talus {

/// The order of the runs of a study: realization 0, the replicates, then the other realizations.
/// @param replicates  of the study
std::int64_t rank_of(const RunKey& key, std::int64_t replicates);
RunKey run_of_rank(std::int64_t rank, std::int64_t replicates);

/// The one failure rule: more than `max_failed_share` of the planned realizations have failed, so that nothing can make
/// the study right again; or all have been made and none is done.
bool too_many_failed(std::int64_t failed, std::int64_t done, std::int64_t planned, double max_failed_share);

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
  std::int64_t done() const { return done_; }
  std::int64_t failed() const { return failed_; }
  std::int64_t replicates_made() const { return replicates_; }
  /// Of the influence zone over what is done; unset while nothing can be said [m].
  std::optional<double> mean() const;
  std::optional<double> mean_half_width() const;

 private:
  double max_failed_share_;
  std::int64_t realizations_, first_, end_;
  std::int64_t done_ = 0, failed_ = 0, replicates_ = 0;
  double mean_ = 0.0, square_ = 0.0;
  std::int64_t farthest_index_ = -1;
  double farthest_ = 0.0;
  StopRule stop_;
  std::map<std::int64_t, std::optional<double>> ahead_;  ///< influence zones beyond the first gap in the indices
  std::int64_t next_ = 0;                                ///< the first gap
};

}  // namespace talus

#pragma once
// When a study may end before its planned number: a rule that depends on the realizations, never on who finished first.

#include <cstdint>
#include <optional>
#include <vector>

#include "study/plan.hpp"
#include "study/record.hpp"

namespace talus {

/// Fewer finished realizations never stop a study.
inline constexpr std::int64_t least_to_stop = 10;

/// Finds the smallest n such that the realizations 0..n-1 are all recorded, at least `least_to_stop` of them done, and
/// the 95 % half width of their mean influence zone is at most a given one. The study is then cut to 0..n-1. Taken at
/// the first n that suits, the interval covers a little less often than 95 %.
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
  std::int64_t done_ = 0;
  double mean_ = 0.0, square_ = 0.0;  ///< mean and sum of squared deviations (Welford 1962)
  std::optional<std::int64_t> size_;
};

/// The size at which the rule stops the study of these records (in order of index); nothing where it does not.
std::optional<std::int64_t> stopping_size(const Plan& plan, const std::vector<Record>& records);

}  // namespace talus

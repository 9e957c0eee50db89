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

/// The smallest n such that the realizations 0..n-1 are all recorded, at least `least_to_stop` of them done, and the 95
/// % half width of their mean influence zone is at most `plan.study.stop_half_width`; nothing where there is none, or
/// no such wish.
///
/// The study is then cut to 0..n-1. Taken at the first n that suits, the interval covers a little less often than 95 %.
/// @param records  in order of index
std::optional<std::int64_t> stopping_size(const Plan& plan, const std::vector<Record>& records);

}  // namespace talus

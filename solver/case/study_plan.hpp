#pragma once
// From a case to the plan of its study.

#include <cstdint>
#include <string>

#include "case/load.hpp"
#include "study/plan.hpp"

namespace talus {

/// The plan of a study of `loaded` with a given seed.
/// @throws ConfigError when the study cannot be done: every realization would be the same, or a Latin hypercube asked
/// to stop early
Plan make_plan(const LoadedCase& loaded, std::uint64_t seed, const std::string& version);

}  // namespace talus

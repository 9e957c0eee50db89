#pragma once
// The seed of a study, run or field that gives none.

#include <cstdint>

namespace talus {

/// From the entropy of the system, at most max_exact_integer so that every reader of JSON keeps it exact. It is
/// recorded with the results, which it is enough to repeat. Thread-safe.
std::uint64_t random_seed();

}  // namespace talus

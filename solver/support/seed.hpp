#pragma once
// The seed of a study, run or field that gives none.

#include <cstdint>
#include <random>

#include "support/text.hpp"

namespace talus {

/// From the entropy of the system, at most max_exact_integer so that every reader of JSON keeps it exact. It is
/// recorded with the results, which it is enough to repeat. Thread-safe.
inline std::uint64_t random_seed() {
  std::random_device entropy;
  const std::uint64_t high = entropy();
  return ((high << 32) | entropy()) & static_cast<std::uint64_t>(max_exact_integer);
}

}  // namespace talus

#include "support/seed.hpp"

#include <random>

#include "support/text.hpp"

namespace talus {

std::uint64_t random_seed() {
  std::random_device entropy;
  const std::uint64_t high = entropy();
  return ((high << 32) | entropy()) & static_cast<std::uint64_t>(max_exact_integer);
}

}  // namespace talus

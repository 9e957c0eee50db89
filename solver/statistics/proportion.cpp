#include "statistics/proportion.hpp"

#include <cassert>

#include "statistics/histogram.hpp"

namespace talus {

Proportion proportion(std::int64_t k, std::int64_t n, std::int64_t unknown) {
  assert(k >= 0 && unknown >= 0 && k + unknown <= n);
  if (n == 0) return {};
  return {.k = k,
          .n = n,
          .unknown = unknown,
          .p = static_cast<double>(k) / static_cast<double>(n),
          .lo = *wilson(k, n).lo,
          .hi = *wilson(k + unknown, n).hi};
}

}  // namespace talus

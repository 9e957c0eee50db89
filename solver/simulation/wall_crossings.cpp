#include "simulation/wall_crossings.hpp"

#include <numeric>

namespace talus {

void WallCrossings::observe(const Soil& soil) {
#pragma omp parallel for schedule(static, 512)
  for (std::size_t i = 0; i < soil.n_active; ++i)
    if (signed_distance(soil.position(i), walls_) < 0.0) seen_[static_cast<std::size_t>(soil.id[i])] = 1;
}

std::int64_t WallCrossings::count() const { return std::accumulate(seen_.begin(), seen_.end(), std::int64_t{0}); }

}  // namespace talus

#pragma once
// The particle of a case nearest to a point.

#include <algorithm>

#include "case/load.hpp"
#include "particles/geometry.hpp"
#include "run/realization.hpp"

namespace talus::test {

/// Index among the soil particles. @param x  m
inline std::size_t particle_nearest(const Case& c, Vec2 x) {
  const ParticlePlan plan = plan_particles(c.model);
  return static_cast<std::size_t>(
      std::ranges::min_element(plan.soil, {}, [&](const SoilPoint& p) { return norm2(p.x - x); }) - plan.soil.begin());
}

}  // namespace talus::test

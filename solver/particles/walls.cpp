#include "particles/walls.hpp"

#include <cmath>
#include <cstdint>

#include "particles/ground.hpp"

namespace talus {

std::vector<WallPoint> fill_walls(const Polyline& wall, double dx, int layers, std::int32_t boundary) {
  const Ground ground({wall});
  std::vector<WallPoint> points;
  for (int k = 0; k < layers; ++k) {
    const double depth = (k + 0.5) * dx;
    const Polyline row = offset_into_rock(wall, depth);
    const double length = row.length();
    const auto n = static_cast<std::int64_t>(std::max(1.0, std::round(length / dx)));
    const double first = wall.closed ? 0.0 : 0.5;  // a ring starts on a corner, an open row half a spacing in
    for (std::int64_t i = 0; i < n; ++i) {
      const Vec2 x = row.at((static_cast<double>(i) + first) * length / static_cast<double>(n));
      const Ground::Nearest foot = ground.nearest(x);
      // Where a sharp ridge folds the row over itself, the particles that came too near the surface are dropped.
      if (-foot.distance < depth - 0.25 * dx) continue;
      points.push_back({x, foot.normal, -foot.distance, boundary});
    }
  }
  return points;
}

}  // namespace talus

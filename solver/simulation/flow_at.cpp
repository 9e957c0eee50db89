#include "simulation/flow_at.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace talus {
namespace {

constexpr double reach_in_spacings = 3.0;  ///< as that of thickness()

/// Weighted sums at one place.
struct FlowColumn {
  double area = 0.0;       ///< sum A w [m]
  double mass = 0.0;       ///< sum m w [kg/m2]
  Vec2 momentum;           ///< sum m v w [kg/(m s)]
  double momentum2 = 0.0;  ///< sum m v^2 w [Pa m]
};

/// w(d) = 15/(16 R) (1 - (d/R)^2)^2 for |d| < R [1/m]
double weight(double d, double R) {
  const double q = d / R, inside = 1.0 - q * q;
  return inside > 0.0 ? 15.0 / (16.0 * R) * inside * inside : 0.0;
}

}  // namespace

double target_reach(double dx) { return reach_in_spacings * dx; }

TargetFlow flow_at(const Target& target, const Soil& soil, std::span<const Material> materials, double dx) {
  const double R = target_reach(dx), length = target.to - target.from;
  const auto pieces = static_cast<std::size_t>(std::ceil(length / (0.5 * R)));
  const double step = pieces > 0 ? length / static_cast<double>(pieces) : 1.0;
  std::vector<FlowColumn> columns(pieces + 1);
  const auto last = static_cast<double>(pieces);
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    const double s = soil.x[i] - target.from;
    if (s <= -R || s >= length + R) continue;
    const double rho0 = materials[static_cast<std::size_t>(soil.material[i])].rho0;
    const auto first = static_cast<std::size_t>(std::clamp(std::ceil((s - R) / step), 0.0, last));
    const auto end = static_cast<std::size_t>(std::clamp(std::floor((s + R) / step), 0.0, last)) + 1;
    for (std::size_t k = first; k < end; ++k) {
      const double w = weight(s - static_cast<double>(k) * step, R), m_w = soil.m[i] * w;
      const Vec2 v = soil.velocity(i);
      columns[k].area += m_w / rho0;
      columns[k].mass += m_w;
      columns[k].momentum += m_w * v;
      columns[k].momentum2 += m_w * norm2(v);
    }
  }
  TargetFlow flow;
  for (const FlowColumn& column : columns) {
    flow.depth = std::max(flow.depth, column.area);
    if (column.area < target.threshold) continue;
    flow.speed = std::max(flow.speed, norm(column.momentum) / column.mass);
    flow.dynamic_pressure = std::max(flow.dynamic_pressure, column.momentum2 / column.area);
  }
  return flow;
}

}  // namespace talus

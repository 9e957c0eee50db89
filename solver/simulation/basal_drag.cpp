#include "simulation/basal_drag.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

constexpr double drag_column_width = 4.0;  ///< [dx]; as wide as those of the thickness

}  // namespace

BasalDrag::BasalDrag(const FlowConstants& k, WallParticles& walls) {
  if (!has_turbulent_walls(k.boundaries)) return;
  g_ = norm(k.g);
  width_ = drag_column_width * k.dx;
  for (const ConstitutiveParameters& soil : k.soils) rho0_.push_back(soil.eos.rho0);
  const auto foot = [&](std::size_t w) { return walls.x[w] + walls.depth[w] * walls.nx[w]; };
  double right = -1e300;
  left_ = 1e300;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    left_ = std::min(left_, foot(w));
    right = std::max(right, foot(w));
    xi_.push_back(k.boundaries[static_cast<std::size_t>(walls.boundary[w])].xi.value_or(0.0));
  }
  columns_ = static_cast<std::size_t>((right - left_) / width_) + 1;
  for (std::size_t w = 0; w < walls.size(); ++w) over_.push_back(column(foot(w)));
  walls.drag.assign(walls.size(), 0.0);
}

std::size_t BasalDrag::column(double x) const {
  return static_cast<std::size_t>(std::clamp((x - left_) / width_, 0.0, static_cast<double>(columns_ - 1)));
}

void BasalDrag::act(const Soil& soil, WallParticles& walls) const {
  std::vector<Column> columns(columns_);
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    Column& c = columns[column(soil.x[i])];
    c.mass += soil.m[i];
    c.volume += soil.m[i] / rho0_[static_cast<std::size_t>(soil.material[i])];
    c.momentum = c.momentum + soil.m[i] * soil.velocity(i);
  }
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Column& c = columns[over_[w]];
    const bool acts = xi_[w] > 0.0 && c.mass > 0.0;
    walls.drag[w] = acts ? turbulent_friction(c.mass / c.volume, g_, norm(c.momentum) / c.mass, xi_[w]) : 0.0;
  }
}

}  // namespace talus

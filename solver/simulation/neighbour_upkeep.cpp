#include "simulation/neighbour_upkeep.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

NeighbourUpkeep::NeighbourUpkeep(WallParticles& walls, double h, double dx) : h_(h), dx_(dx) {
  cells_.walls.build(walls.x, walls.y, 2.0 * h);
  for (auto* array : {&walls.x, &walls.y, &walls.nx, &walls.ny, &walls.depth})
    permute(*array, cells_.walls.order(), scratch_);
  permute(walls.boundary, cells_.walls.order(), scratch_);
}

void NeighbourUpkeep::prepare(Soil& soil, const WallParticles& walls, Flow& flow, double dt, double max_speed) {
  const double to_midpoint = 0.5 * dt * max_speed;
  Stopwatch watch;
  if (!moved_since_sort_ || *moved_since_sort_ + to_midpoint > flow.resort_distance() * h_) {
    sort(soil, flow);
    watch.lap(times_.sort);
    rebuild_lists(soil, walls, flow, dt * max_speed);
  } else if (drift_since_rebuild_ + to_midpoint > verlet_skin_) {
    rebuild_lists(soil, walls, flow, dt * max_speed);
  }
  watch.lap(times_.lists);
}

void NeighbourUpkeep::advance(const StepExtrema& extrema) {
  moved_since_sort_ = extrema.moved_since_sort;
  drift_since_rebuild_ += extrema.max_displacement;
}

void NeighbourUpkeep::restore(std::optional<double> moved_since_sort, const Soil& soil, const WallParticles& walls,
                              Flow& flow) {
  moved_since_sort_ = moved_since_sort;
  build_cells(soil, flow);
  rebuild_lists(soil, walls, flow, 0.0);
}

/// Cells over where the particles stood when they were sorted, wide enough for what they may move until the next sort.
void NeighbourUpkeep::build_cells(const Soil& soil, const Flow& flow) {
  const std::span<const float> x(soil.x_sorted), y(soil.y_sorted);
  cells_.soil.build(x.first(soil.n_active), y.first(soil.n_active), (2.0 + flow.resort_distance()) * h_);
}

void NeighbourUpkeep::sort(Soil& soil, Flow& flow) {
  const auto round = [](double value) { return static_cast<float>(value); };
  std::ranges::transform(soil.x, soil.x_sorted.begin(), round);
  std::ranges::transform(soil.y, soil.y_sorted.begin(), round);
  build_cells(soil, flow);
  const auto order = cells_.soil.order();
  for_each_state(soil, [&](const char*, auto& array) { permute(array, order, scratch_); });
  flow.permute_rates(soil, order, scratch_);
  permute(soil.x_sorted, order, scratch_);
  permute(soil.y_sorted, order, scratch_);
  permute(soil.material, order, scratch_);
  permute(soil.id, order, scratch_);
  moved_since_sort_ = 0.0;
}

/// A larger skin makes the lists longer, a smaller one makes rebuilds more frequent; the optimum grows as the root of
/// the displacement per step. Measured: see solver/sph/SPEED.md.
void NeighbourUpkeep::rebuild_lists(const Soil& soil, const WallParticles& walls, Flow& flow, double displacement) {
  const double widest = flow.resort_distance() * h_;
  const double best = std::clamp(0.4 * std::sqrt(dx_ * displacement), 0.005 * h_, widest);
  verlet_skin_ = std::max(best, 0.51 * displacement);
  drift_since_rebuild_ = 0.0;
  flow.rebuild_neighbour_lists(soil, walls, cells_, widest, verlet_skin_);
}

}  // namespace talus

#pragma once
// When the soil is sorted by cell again, and when the Verlet lists are rebuilt.

#include <optional>
#include <vector>

#include "integrate/flow.hpp"

namespace talus {

/// Keeps the cells, and through the flow the neighbour lists, good for every particle's next step.
class NeighbourUpkeep {
 public:
  /// Sorts the walls by cell, once and for all.
  /// @param h  smoothing length [m]; @param dx  particle spacing [m]
  NeighbourUpkeep(WallParticles& walls, double h, double dx);

  /// Cells of the soil as it was when last sorted, and of the walls.
  const ParticleCells& cells() const { return cells_; }

  /// Sorts and rebuilds as far as a step of dt [s] at speeds up to max_speed [m/s] needs it. Positions in the middle of
  /// the step are searched against positions at the last sort.
  void prepare(Soil& soil, const WallParticles& walls, Flow& flow, double dt, double max_speed);
  /// To be called after a step.
  void advance(const StepExtrema& extrema);
  /// To be called when particles have changed places: the soil is sorted before the next step.
  void require_sort() { moved_since_sort_.reset(); }

  /// Largest displacement since the last sort [m]; unset: the soil must be sorted before the next step.
  std::optional<double> moved_since_sort() const { return moved_since_sort_; }
  /// For a soil that comes from a checkpoint: cells and lists from where the soil stood when it was last sorted.
  void restore(std::optional<double> moved_since_sort, const Soil& soil, const WallParticles& walls, Flow& flow);

  /// Wall clock spent on sorting and on lists.
  const StageTimes& times() const { return times_; }

 private:
  void sort(Soil& soil, Flow& flow);
  void build_cells(const Soil& soil, const Flow& flow);
  void rebuild_lists(const Soil& soil, const WallParticles& walls, Flow& flow, double displacement);

  double h_, dx_;
  ParticleCells cells_;
  std::optional<double> moved_since_sort_;
  double verlet_skin_ = 0.0;          ///< displacement that the lists allow for [m]
  double drift_since_rebuild_ = 0.0;  ///< upper bound of the displacement since the last rebuild [m]
  std::vector<double> scratch_;
  StageTimes times_;
};

}  // namespace talus

#pragma once
// The right-hand side in vectors of single precision (Highway, chosen for the processor at run time). The plain
// double-precision loops in right_hand_side.cpp are its oracle.

#include <string>

#include "particles/particles.hpp"
#include "sph/flow_constants.hpp"
#include "sph/packed_flow.hpp"
#include "sph/step_extrema.hpp"
#include "sph/wall_load.hpp"

namespace talus {

/// Particles in one vector.
std::size_t cluster_size();
/// Name of the instruction set that the loops use on this processor: "AVX2", "AVX3_ZEN4", ...
const char* pair_loops_target();
/// Keeps the loops from using anything better than "AVX2" or "SSE4", to compare.
/// @returns false for another name
bool limit_pair_loops(const std::string& name);

/// Packs position, velocity and density of soil particles as they will be after `ahead` [s] at the present rates.
void pack_soil(PackedFlow& f, const FlowConstants& k, const Soil& soil, double ahead, Range range);
/// Packs what does not change of the soil while its order stays: cohesion and friction.
void pack_strength(PackedFlow& f, const Soil& soil);
/// Packs what does not change of all walls: place, normal, depth and friction; and their cohesion.
void pack_walls(PackedFlow& f, const FlowConstants& k, const WallParticles& walls);
/// Packs the cohesion of all walls, with what the speed of the flow adds to it.
void pack_wall_cohesion(PackedFlow& f, const FlowConstants& k, const WallParticles& walls);

/// Which neighbours to list.
struct NeighbourSearch {
  const FixedPoint& fixed;
  std::span<const std::uint32_t> clusters;  ///< of the targets, as clusters() returns them
  std::span<const float> targets;           ///< in groups of four that begin with x and y
  std::span<const float> sources;           ///< the same
  const CellList& cells;                    ///< of the sources
  double distance;                          ///< of a source to the bounding box of a cluster, at most [m]
  double moved;                             ///< by any source since the cells were built, at most [m]
  std::uint32_t padding;                    ///< place that fills the lists up: one behind the last source
};
/// Lists the neighbours of the clusters of one batch.
void list_neighbours(const NeighbourSearch& search, std::size_t batch, ClusterList& list);

/// First pass over some of the soil's clusters: velocity gradient, density rate, stress ([Z20] Eqs. 1-10), with the
/// elastic stress as it will be after `ahead` [s]. `keep`: what returning it to the yield surface takes off is taken
/// off the soil's. `measure`: writes the powers of the stress.
void stress_pass(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, bool measure,
                 Range clusters);
/// Stress of one batch of the walls' clusters, extrapolated from the soil.
void wall_stress_pass(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t batch);
/// Second pass over some of the soil's clusters: acceleration ([Z20] Eq. 2), gravity included. `measure`: writes the
/// powers of the artificial viscosity and of the walls.
void momentum_pass(PackedFlow& f, const FlowConstants& k, bool measure, Range clusters);

/// Load of each of some of the soil's clusters on one boundary, at the state of the last evaluation.
/// @param slot   of the boundary in PackedWalls::slot; @param about  point of the moment [m]
/// @param loads  written for these clusters
void load_pass(const PackedFlow& f, const FlowConstants& k, std::int32_t slot, Vec2 about, Range clusters,
               WallLoad* loads);

/// Moves soil particles on by dt [s] at the present rates, positions with the velocities of the last evaluation
/// (`midpoint_velocity`) or with the mean of the old and the new ones, and packs the outcome.
StepExtrema move_soil(PackedFlow& f, const FlowConstants& k, Soil& soil, double dt, bool midpoint_velocity,
                      Range range);

}  // namespace talus

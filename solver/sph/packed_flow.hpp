#pragma once
// Particles as the vectorised pair loops read them: single precision, four values a group so that a neighbour is one or
// two cache lines, positions as fixed point so that differences of neighbours are exact however large the terrain.
//
// Neighbours of clusters: as many particles as a vector has lanes, close to each other, share one list of the particles
// that may come near any of them (after Pall & Hess 2013). One vector then holds one value of all particles of a
// cluster, and each particle sums its neighbours in ascending order whatever the width of the vector.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "neighbours/cell_list.hpp"
#include "particles/geometry_input.hpp"
#include "sph/powers.hpp"

namespace talus {

/// Consecutive particles or clusters, [begin, end).
struct Range {
  std::size_t begin, end;
};

/// Positions in whole units of `quantum` from `lo`.
struct FixedPoint {
  Vec2 lo;               ///< [m]
  double quantum = 1.0;  ///< metres per unit

  /// For points of `box` and up to 4 h around it, in [0, 2^30]: room for differences of any two in 32 bits.
  static FixedPoint covering(Box box, double h);
};

/// Place n, one behind the last of n particles, is far from everything and has no volume; so are some more, so that
/// whole vectors can be loaded from anywhere. Integers are kept as bit patterns of floats.
struct PackedSoil {
  std::vector<float> motion;      ///< x, y [quantum, as integers], vx, vy [m/s]
  std::vector<float> density;     ///< m/rho [m2], rho/rho0 - 1 less its hydrostatic part [-], rho [kg/m3], material
  std::vector<float> stress;      ///< sxx, syy, sxy, p [Pa]
  std::vector<float> strain;      ///< strain rate over h: exx, eyy, exy [m/s per quantum2], unused
  std::vector<float> q;           ///< rho/rho0 - 1 [-], not grouped
  std::vector<float> c, tan_phi;  ///< as in Soil, not grouped; packed with the neighbour lists
  std::vector<float> ax, ay, drho, dtxx, dtyy, dtxy, gamma_dot;  ///< of the last evaluation, as in Soil

  void resize(std::size_t n);
  std::size_t size() const { return n_; }

 private:
  std::size_t n_ = 0;
};

/// WallSlip as PackedWalls keeps it.
constexpr float slip_code(WallSlip slip) { return static_cast<float>(slip); }

struct PackedWalls {
  std::vector<float> place;        ///< x, y [quantum, as integers], nx, ny [-]
  std::vector<float> stress;       ///< sxx, syy, sxy [Pa], depth [m]
  std::vector<float> slip;         ///< WallSlip as a number, not grouped
  std::vector<float> tan_phi;      ///< of the wall's friction angle, infinite where it has none [-], not grouped
  std::vector<float> c;            ///< of the wall's cohesion, infinite where it has none [Pa], not grouped
  std::vector<std::int32_t> slot;  ///< of its boundary among those whose load is asked for, else -1; not grouped
  void resize(std::size_t n);
};

/// Cuts places in cell order into clusters of up to `lanes`; no cluster reaches over the end of a row of cells.
/// @returns first place of each cluster, and one more: the number of places
std::vector<std::uint32_t> clusters(const CellList& cells, std::size_t lanes);

/// For each cluster the places of the particles to sum over, ascending.
struct ClusterList {
  /// Clusters whose lists a thread makes at a time, one after the other in memory.
  static constexpr std::size_t batch_size = 32;
  /// Each list is filled up to a multiple of it with a place where nothing is, and so many more stand behind the last.
  static constexpr std::size_t block = 2;

  struct Batch {
    std::vector<std::uint32_t> places;
    std::array<std::uint32_t, batch_size + 1> at;  ///< where each cluster's part of `places` begins
  };
  std::vector<Batch> batches;

  /// For the clusters of `first`, as clusters() returns them.
  void resize(std::span<const std::uint32_t> first) { batches.resize((first.size() + batch_size - 2) / batch_size); }
};

/// What the vectorised loops read and write.
struct PackedFlow {
  FixedPoint fixed;
  std::optional<double> mass;  ///< of every soil particle, where all have the same [kg/m]
  PackedSoil soil;
  PackedWalls walls;
  ParticlePowers<float> powers;                                         ///< of the last evaluation that measured them
  std::vector<std::uint32_t> soil_clusters = {0}, wall_clusters = {0};  ///< first place of each, and one more
  ClusterList soil_soil, soil_wall, wall_soil;                          ///< target_source
};

}  // namespace talus

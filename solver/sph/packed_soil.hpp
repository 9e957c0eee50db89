#pragma once
// The soil as the vectorised pair loops read it: single precision, padded, positions as fixed point so that differences of
// neighbours are exact however large the terrain.

#include <cstdint>
#include <span>
#include <vector>

#include "particles/particles.hpp"

namespace talus {

/// One contiguous run of particles [begin, end).
struct Chunk {
  std::size_t begin, end;
};

/// Arrays of the active soil in cell order, each with `padding` entries behind the last particle so that whole vectors can be
/// loaded from anywhere.
struct PackedSoil {
  static constexpr std::size_t padding = 16;

  double quantum = 1.0;              ///< metres per unit of x, y
  std::vector<std::int32_t> x, y;    ///< position [quantum] from a corner of the soil
  std::vector<float> vx, vy;         ///< [m/s]
  std::vector<float> V;              ///< m/rho [m2]
  std::vector<float> q;              ///< rho/rho0 - 1 [-]
  std::vector<float> rho;            ///< [kg/m3]
  std::vector<float> sxx, syy, sxy;  ///< Cauchy stress [Pa]
  std::vector<std::int32_t> material;

  /// Makes room for n particles and chooses the fixed point of `box` [m]; positions may leave it by half its size.
  void resize(std::size_t n, Box box);
  /// Packs position, velocity and density of a chunk; `rho0` by material [kg/m3].
  void pack_state(const Soil& soil, Chunk chunk, std::span<const double> rho0);
  /// Packs the stress of a chunk.
  void pack_stress(const Soil& soil, Chunk chunk);

 private:
  Vec2 lo_;
};

}  // namespace talus

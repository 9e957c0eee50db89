#pragma once
// The soil-soil pair sums of the right-hand side, vectorised (Highway, chosen for the processor at run time). The plain
// double-precision loops in right_hand_side.cpp are their oracle.

#include "neighbours/cell_list.hpp"
#include "sph/artificial_viscosity.hpp"
#include "sph/packed_soil.hpp"

namespace talus {

/// What the first pass leaves for each particle: velocity gradient [1/s] and diffusion sum.
struct GradientSums {
  std::vector<float> Lxx, Lxy, Lyx, Lyy, diffusion;
  void resize(std::size_t n);
};

/// What pairs need to know beside the particles.
struct PairConstants {
  float h;            ///< smoothing length [m]
  float sigma_h2;     ///< of the kernel: sigma/h^2 [1/m4]
  bool wendland;      ///< Wendland C2 instead of the cubic spline
  bool diffuse;       ///< delta-SPH diffusion wanted
  bool one_material;  ///< no need to compare materials
  Vec2 hydrostatic;   ///< g/c_s^2: relative density per metre [1/m]
  float alpha_c, beta;///< artificial viscosity: alpha c_s [m/s], beta [-]
};

/// Velocity gradient and diffusion of the particles of a chunk: [Z20] Eqs. 1 (volume form), 9; sph/density_filter.hpp.
void gradient_sums(const PackedSoil& packed, const Soil& soil, const CellList& cells, const PairConstants& k, Chunk chunk, GradientSums& out);

/// Accelerations of the particles of a chunk from soil-soil pairs, without gravity: [Z20] Eq. 2. Written to soil.ax, soil.ay.
void momentum_sums(const PackedSoil& packed, Soil& soil, const CellList& cells, const PairConstants& k, Chunk chunk);

/// Name of the instruction set that the pair loops use on this processor: "AVX2", "AVX3_ZEN4", ...
const char* pair_loops_target();

}  // namespace talus

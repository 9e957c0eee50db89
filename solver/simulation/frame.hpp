#pragma once
// A snapshot of a run.

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec2.hpp"
#include "support/measures.hpp"

namespace talus {

/// All particles at one time, in order of id: soil 0..n_soil-1, then walls. Every array has the same length; cohesion
/// and viscosity are empty where they do not vary within the materials.
struct Frame {
  double time = 0.0;               ///< [s]
  std::int64_t step = 0;           ///< steps made
  Vec2 origin;                     ///< Terrain::origin, to be added to positions [m]
  std::size_t n_soil = 0;          ///< how many of the particles are soil
  std::vector<Vec2> position;      ///< [m]
  std::vector<Vec2> displacement;  ///< since the start [m]
  std::vector<Vec2> velocity;      ///< [m/s]
  std::vector<double> density;     ///< [kg/m3]
  std::vector<double> pressure;    ///< [Pa], positive in compression
  std::vector<double> tan_phi;     ///< tangent of the friction angle [-]; 0 for walls
  std::vector<double> shear_rate;  ///< gamma_dot [1/s]
  std::vector<double> stdev;       ///< over realizations, of what is shown [rad, Pa, kg/m3, Pa s]; empty in a run
  std::vector<std::array<double, 4>> stress;  ///< sigma xx, yy, zz, xy [Pa], positive in tension
  std::vector<double> cohesion;               ///< [Pa]; 0 for walls
  std::vector<double> viscosity;              ///< once it has yielded [Pa s]; 0 for walls
};

}  // namespace talus

#pragma once
// What a run keeps constant and every loop sees.

#include <vector>

#include "material/bingham.hpp"
#include "material/equation_of_state.hpp"
#include "material/material.hpp"
#include "math/vec2.hpp"
#include "sph/numerics.hpp"

namespace talus {

/// What the law of a point needs to know of its material.
struct PointLaw {
  EquationOfState eos;
  double c;  ///< cohesion [Pa]
  Bingham bingham;
  double G;  ///< numerical shear modulus of the elastic law [Pa]
};

/// Constants of a run that every pair sees.
struct FlowConstants {
  double h = 0.0;    ///< smoothing length [m]
  double dx = 0.0;   ///< particle spacing [m]
  double c_s = 0.0;  ///< speed of sound [m/s]
  Vec2 g;            ///< gravity [m/s2]
  Rheology rheology;
  Numerics numerics;
  Walls walls;
  std::vector<PointLaw> laws;  ///< by material
};

/// Builds the point laws of `materials`; c_s [m/s].
std::vector<PointLaw> point_laws(const std::vector<Material>& materials, const Rheology& rheology, double c_s);

}  // namespace talus

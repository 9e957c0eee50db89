#pragma once
// What a run keeps constant and every loop sees.

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "material/equation_of_state.hpp"
#include "material/material.hpp"
#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"
#include "particles/particles.hpp"
#include "sph/numerics.hpp"

namespace talus {

/// What the constitutive models need to know of a material.
struct ConstitutiveParameters {
  EquationOfState eos;
  double eta;  ///< viscosity once it has yielded [Pa s]
  double G;    ///< numerical shear modulus of the elastic law [Pa]
  InertialFriction<> mu_i;
};

/// What the wall law needs to know of a boundary.
struct WallFriction {
  WallSlip slip = WallSlip::no_slip;
  double tan_phi = std::numeric_limits<double>::infinity();  ///< with WallSlip::friction; otherwise unbounded [-]
  double c = std::numeric_limits<double>::infinity();        ///< cohesion, where the boundary has its own [Pa]
  std::optional<double> xi = {};                             ///< turbulence coefficient of Voellmy's law [m/s2]
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
  std::vector<ConstitutiveParameters> soils;  ///< by material
  std::vector<WallFriction> boundaries;       ///< by boundary, then the stretches of all boundaries
};

/// Reference density of a soil particle: its own, or that of its material [kg/m3].
inline double reference_density(const FlowConstants& k, const Soil& soil, std::size_t i) {
  return soil.rho0.empty() ? k.soils[static_cast<std::size_t>(soil.material[i])].eos.rho0 : soil.rho0[i];
}
/// Viscosity of a soil particle once it has yielded, without mu(I): its own, or that of its material [Pa s].
inline double stated_viscosity(const FlowConstants& k, const Soil& soil, std::size_t i) {
  return soil.eta.empty() ? k.soils[static_cast<std::size_t>(soil.material[i])].eta : soil.eta[i];
}
/// Equation of state of a soil particle. Its stiffness is that of the material whatever its own density, so that equal
/// pressures mean equal rho/rho0 and the diffusion of density leaves soil of varying density at rest alone.
inline EquationOfState equation_of_state(const FlowConstants& k, const Soil& soil, std::size_t i) {
  return {reference_density(k, soil, i), k.soils[static_cast<std::size_t>(soil.material[i])].eos.B};
}

/// @param c_s  speed of sound [m/s]
std::vector<ConstitutiveParameters> constitutive_parameters(const std::vector<Material>& materials,
                                                            const Rheology& rheology, double c_s);

/// The shear viscosity for which the linear term of the artificial viscosity stands where it acts on the whole approach
/// of two particles: rho alpha c_s h/8 in two dimensions (Monaghan 2005, Rep. Prog. Phys. 68). [Pa s]
/// @param rho0  reference density of the soil [kg/m3]
double artificial_shear_viscosity(const FlowConstants& k, double rho0);

/// Of each boundary, then of the stretches of all of them, in their order. Where one has a turbulence coefficient, no
/// value is infinite, only so large that it never counts.
std::vector<WallFriction> wall_friction(std::span<const Boundary> boundaries);
/// Index of the friction of boundary b at x [m] in what wall_friction() returns.
std::size_t friction_index(std::span<const Boundary> boundaries, std::size_t b, double x);

/// Whether one has a turbulence coefficient. Then the weaker of wall and soil is the one that yields at the lower
/// stress, since a term that grows with the speed has no counterpart in the soil; otherwise it has the smaller friction
/// angle and the smaller cohesion of both.
bool has_turbulent_walls(std::span<const WallFriction> walls);

/// Cohesion of a wall particle, with what the speed of the flow adds to it [Pa].
double wall_cohesion(const FlowConstants& k, const WallParticles& walls, std::size_t w);

}  // namespace talus

#include "sph/flow_constants.hpp"

#include <cmath>

namespace talus {
namespace {

/// Shear modulus over rho0 c_s^2, which is the bulk modulus of the equation of state: a Poisson's ratio of 0.36. Fronts
/// come out too far in proportion to 1/G: before it yields, soil is strained by tau_y/G.
constexpr double default_shear_share = 0.3;

}  // namespace

std::vector<ConstitutiveParameters> constitutive_parameters(const std::vector<Material>& materials,
                                                            const Rheology& rheology, double c_s) {
  std::vector<ConstitutiveParameters> soils;
  for (const Material& m : materials)
    soils.push_back({.eos = EquationOfState::weakly_compressible(m.rho0, c_s),
                     .eta = m.eta,
                     .G = rheology.G.value_or(default_shear_share * m.rho0 * c_s * c_s),
                     .mu_i = m.mu_i.value_or(InertialFriction<>{})});
  return soils;
}

double artificial_shear_viscosity(const FlowConstants& k, double rho0) {
  return rho0 * k.numerics.alpha * k.c_s * k.h / 8.0;
}

std::vector<WallFriction> wall_friction(std::span<const Boundary> boundaries) {
  std::vector<WallFriction> walls;
  for (const Boundary& b : boundaries) {
    walls.push_back({.slip = b.slip});
    if (b.slip != WallSlip::friction) continue;
    walls.back().tan_phi = std::tan(b.phi);
    if (b.c) walls.back().c = *b.c;
  }
  return walls;
}

}  // namespace talus

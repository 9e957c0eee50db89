#include "sph/flow_constants.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Shear modulus over rho0 c_s^2, which is the bulk modulus of the equation of state: a Poisson's ratio of 0.36. Fronts
/// come out too far in proportion to 1/G: before it yields, soil is strained by tau_y/G.
constexpr double default_shear_share = 0.3;

constexpr double beyond_all_friction = 1e6, beyond_all_cohesion = 1e20;  ///< [-], [Pa]

/// Soil does not stick to a wall with a turbulence coefficient unless it has a cohesion of its own.
WallFriction friction_of(double phi, std::optional<double> c, std::optional<double> xi) {
  WallFriction friction{.slip = WallSlip::friction, .tan_phi = std::tan(phi), .xi = xi};
  if (xi) friction.c = 0.0;
  if (c) friction.c = *c;
  return friction;
}

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
  for (const Boundary& b : boundaries)
    walls.push_back(b.slip == WallSlip::friction ? friction_of(b.phi, b.c, b.xi) : WallFriction{.slip = b.slip});
  for (const Boundary& b : boundaries)
    for (const WallStretch& s : b.stretches) walls.push_back(friction_of(s.phi, s.c, s.xi));
  if (has_turbulent_walls(walls))
    for (WallFriction& wall : walls) {
      wall.tan_phi = std::min(wall.tan_phi, beyond_all_friction);
      wall.c = std::min(wall.c, beyond_all_cohesion);
    }
  return walls;
}

std::size_t friction_index(std::span<const Boundary> boundaries, std::size_t b, double x) {
  std::size_t before = boundaries.size();
  for (std::size_t k = 0; k < b; ++k) before += boundaries[k].stretches.size();
  const std::vector<WallStretch>& own = boundaries[b].stretches;
  for (std::size_t s = 0; s < own.size(); ++s)
    if (x >= own[s].x1 && x < own[s].x2) return before + s;
  return b;
}

bool has_turbulent_walls(std::span<const WallFriction> walls) {
  return std::ranges::any_of(walls, [](const WallFriction& wall) { return wall.xi.has_value(); });
}

double wall_cohesion(const FlowConstants& k, const WallParticles& walls, std::size_t w) {
  const double c = k.boundaries[static_cast<std::size_t>(walls.boundary[w])].c;
  return walls.drag.empty() ? c : c + walls.drag[w];
}

}  // namespace talus

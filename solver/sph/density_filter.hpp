#pragma once
// "Regularized correction of density" ([Z20] 2.1): the Shepard filter, or the diffusion of delta-SPH.

#include "math/vec2.hpp"

namespace talus {

/// delta-SPH diffusion with the hydrostatic part taken out (Antuono 2010; Fourtakas 2019, linearised):
/// drho_i/dt += 2 delta h c_s sum_j V_j (rho_j - rho_i - rho_ij^H) (r_ji . grad_i W_ij)/r^2, rho_ij^H = rho0
/// g.r_ji/c_s^2. Term of one neighbour without the leading 2 delta h c_s. With grad_i W = F r_ij it is -V_j F times the
/// dynamic difference. Linearising the hydrostatic density costs a relative (chi - 1) p/(chi B), below 1 % of a
/// difference that is itself below 1 %.
constexpr double diffusion_term(double V_j, double rho_ji, double rho0, Vec2 g, double c_s, Vec2 r_ij, double F) {
  const double hydrostatic = -rho0 * dot(g, r_ij) / (c_s * c_s);
  return -V_j * (rho_ji - hydrostatic) * F;
}

/// Shepard filter: rho_i/rho0_i <- sum_j V_j q_j W_ij / sum_j V_j W_ij with q = rho/rho0, itself included.
/// For one material this is sum m_j W_ij / sum V_j W_ij.
struct ShepardSum {
  double weighted = 0.0, weight = 0.0;
  constexpr void add(double V_j, double q_j, double W) {
    weighted += V_j * q_j * W;
    weight += V_j * W;
  }
  constexpr double value() const { return weighted / weight; }
};

}  // namespace talus

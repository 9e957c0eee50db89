#pragma once

#include "math/tensor.hpp"

namespace talus {

/// dv_i/dt = sum_j m_j ((sigma_i + sigma_j)/(rho_i rho_j) - Pi_ij I) . grad_i W_ij + g    [Z20] Eq. 2
/// Term of one neighbour. Antisymmetric in i and j but for m_j, so that pairs conserve linear momentum.
constexpr Vec2 momentum_term(double m_j, Sym2 s_i, Sym2 s_j, double rho_i_rho_j, double Pi, Vec2 grad_W) {
  return m_j * ((1.0 / rho_i_rho_j) * ((s_i + s_j) * grad_W) - Pi * grad_W);
}

}  // namespace talus

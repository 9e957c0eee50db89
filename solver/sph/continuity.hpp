#pragma once

#include "math/vec2.hpp"

namespace talus {

/// drho_i/dt = sum_j m_j (v_i - v_j) . grad_i W_ij                          [Z20] Eq. 1
/// Term of one neighbour. Handing in rho_i V_j instead of m_j gives the volume form (Colagrossi & Landrini 2003), which
/// is the same where the density is uniform and stays right across the layers of a slide.
constexpr double continuity_term(double m_j, Vec2 v_ij, Vec2 grad_W) { return m_j * dot(v_ij, grad_W); }

}  // namespace talus

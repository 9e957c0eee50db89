#pragma once

#include "math/tensor.hpp"

namespace talus {

/// L_i = sum_j V_j (v_j - v_i) (x) grad_i W_ij, V_j = m_j/rho_j               [Z20] Eq. 9
/// Term of one neighbour. The paper prints v_i - v_j, which is minus the velocity gradient and would make Eq. 10
/// anti-viscous.
constexpr void add_velocity_gradient(Mat2& L, double V_j, Vec2 v_ij, Vec2 grad_W) {
  L.xx -= V_j * v_ij.x * grad_W.x;
  L.xy -= V_j * v_ij.x * grad_W.y;
  L.yx -= V_j * v_ij.y * grad_W.x;
  L.yy -= V_j * v_ij.y * grad_W.y;
}

}  // namespace talus

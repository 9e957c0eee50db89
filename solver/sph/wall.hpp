#pragma once
// How a fixed wall particle acts on the soil: its virtual velocity and its extrapolated stress.

#include <algorithm>

#include "math/tensor.hpp"
#include "sph/numerics.hpp"

namespace talus {

/// b = min(b_max, 1 + d_j/d_i): the velocity mirrored about the wall line over the soil's own.
/// Takeda 1994, Morris 1997 (b_max = 1.5). d_i: soil to wall line, d_j: wall particle to wall line, both [m].
inline double mirror_ratio(double d_i, double d_j, double b_max) {
  const double gap = std::max(d_i, 1e-6 * d_j);  // a particle on the line, or through it, gets b_max
  return std::min(b_max, 1.0 + d_j / gap);
}

/// v_ij of a soil-wall pair: b v_i for a rough wall; only its normal part for a smooth one.
inline Vec2 wall_relative_velocity(Vec2 v_i, Vec2 n, double b, WallSlip slip) {
  return slip == WallSlip::free_slip ? b * dot(v_i, n) * n : b * v_i;
}

/// A wall that is smoother than the soil is a thin interface layer with the wall's friction angle (after Desai 1984): soil
/// nearer than dx to the wall line yields at the smaller of both.
inline double interface_tan_phi(double tan_phi, double tan_phi_wall, double d_i, double dx) {
  return d_i < dx ? std::min(tan_phi, tan_phi_wall) : tan_phi;
}

/// Shepard interpolation of the soil's stress to a wall particle, pressure with the hydrostatic term of Adami 2012:
/// p_w = sum_f (p_f + rho_f g.r_wf) W / sum_f W, other parts sum_f s_f W / sum_f W.
struct WallStressSum {
  double weight = 0.0, p = 0.0, compression = 0.0;
  Dev t;
  /// c_s serves the hydrostatic part of the compression, linearised: rho/rho0 grows by g.r/c_s^2.
  void add(double W, double p_f, Dev t_f, double rho_f, double rho0_f, Vec2 g, Vec2 r_wf, double c_s) {
    weight += W;
    p += W * (p_f + rho_f * dot(g, r_wf));
    compression += W * (rho_f / rho0_f + dot(g, r_wf) / (c_s * c_s));
    t = t + W * t_f;
  }
};

}  // namespace talus

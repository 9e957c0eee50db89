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

/// A wall that is smoother than the soil is a thin interface layer with the wall's friction angle (after Desai 1984):
/// soil nearer than `thickness` to the wall line yields at the smaller of both.
inline double interface_tan_phi(double tan_phi, double tan_phi_wall, double d_i, double thickness) {
  return d_i < thickness ? std::min(tan_phi, tan_phi_wall) : tan_phi;
}
/// Wide enough to hold most of what the kernel sees from the wall: one row of particles at h = 1.2 dx, two at 1.5 dx.
inline double interface_thickness(double h) { return 1.1 * h; }

/// By how much the soil's deviatoric stress grows on its way to a wall particle: as the pressure does there, at most
/// threefold. Under its own weight a layer carries shear in proportion to its depth, as it carries pressure;
/// extrapolated as a constant the shear would lack that of half a support, and a layer of cohesionless soil would slide
/// at 23 instead of 25 degrees. For rough walls only: along a wall that is smoother than the soil, the wall's friction
/// bounds the shear.
/// @param p_wall  extrapolated pressure [Pa]
/// @param p_soil  the soil's, interpolated without its hydrostatic part [Pa]
inline double deviator_growth(double p_wall, double p_soil) {
  return p_soil > 0.0 ? std::clamp(p_wall / p_soil, 0.0, 3.0) : 1.0;
}

/// A wall particle that sees less of the soil than this share of W(0) sees nothing: in single precision the inverse of
/// a weight that is almost zero would be infinite.
inline constexpr double least_weight = 1e-24;

/// Shepard interpolation of the soil's stress to a wall particle, pressure with the hydrostatic term of Adami 2012:
/// p_w = sum_f (p_f + rho_f g.r_wf) W / sum_f W; the deviator as sum_f t_f W / sum_f W, enlarged by deviator_growth.
struct WallStressSum {
  double weight = 0.0, p = 0.0, p_soil = 0.0, compression = 0.0;
  Dev t;
  /// c_s serves the hydrostatic part of the compression, linearised: rho/rho0 grows by g.r/c_s^2.
  void add(double W, double p_f, Dev t_f, double rho_f, double rho0_f, Vec2 g, Vec2 r_wf, double c_s) {
    weight += W;
    p += W * (p_f + rho_f * dot(g, r_wf));
    p_soil += W * p_f;
    compression += W * (rho_f / rho0_f + dot(g, r_wf) / (c_s * c_s));
    t = t + W * t_f;
  }
};

}  // namespace talus

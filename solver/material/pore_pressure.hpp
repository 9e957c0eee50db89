#pragma once
// Water in the pores: its pressure before the slide, and the share of the friction that it leaves.

#include <algorithm>

namespace talus {

/// cos^2 of the angle whose tangent is `slope` [-].
inline double cos_squared(double slope) { return 1.0 / (1.0 + slope * slope); }

/// u = gamma_w d cos^2(alpha): seepage parallel to a phreatic line of slope tan(alpha), whose equipotentials are
/// perpendicular to it (Haefeli 1948; Skempton & DeLory 1957). Hydrostatic where the line is level. [Pa]
/// @param gamma_w  unit weight of water [N/m3]
/// @param d        depth below the line, vertically [m]; none above it
inline double seepage_pressure(double gamma_w, double d, double slope) {
  return gamma_w * std::max(d, 0.0) * cos_squared(slope);
}

/// u = r_u sigma_v (Bishop & Morgenstern 1960, Geotechnique 10). [Pa]
/// @param sigma_v  total vertical stress [Pa]
inline double ratio_pressure(double r_u, double sigma_v) { return r_u * sigma_v; }

/// lambda = u/sigma_n, sigma_n = sigma_v cos^2(beta): the total normal stress on a plane parallel to a ground of slope
/// tan(beta), that of the infinite slope. 0 without stress. [-]
inline double pore_pressure_ratio(double u, double sigma_v, double slope) {
  return sigma_v > 0.0 ? u / (sigma_v * cos_squared(slope)) : 0.0;
}

/// tan(phi) of total stress: c + (p - u) tan(phi) = c + p (1 - lambda) tan(phi) where u = lambda p. Soil with a ratio
/// of 1 or more is liquefied: it has no friction. [-]
inline double total_stress_friction(double tan_phi, double lambda) { return tan_phi * std::max(0.0, 1.0 - lambda); }

}  // namespace talus

#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/tensor.hpp"

namespace talus {

/// gamma_dot = sqrt(2 dev:dev); simple shear v_x(y) gives |dv_x/dy|, as Eq. 5 needs.
inline double shear_rate_consistent(Dev e) { return std::sqrt(2.0 * double_dot(e)); }
/// gamma_dot = sqrt(2/3 dev:dev), [Z20] Eq. 7 as printed: the yielded stress comes out sqrt(3) times larger.
inline double shear_rate_paper(Dev e) { return std::sqrt(2.0 / 3.0 * double_dot(e)); }

/// tau_y = c + max(p, 0) tan(phi)                                          [Z20] Eq. 5
constexpr double yield_stress(double c, double tan_phi, double p) { return c + std::max(p, 0.0) * tan_phi; }

/// eta' = eta + tau_y / max(gamma_dot, gamma_dot_min)                      [Z20] Eq. 6
struct Bingham {
  double eta;            ///< viscosity                [Pa s], >= 0
  double gamma_dot_min;  ///< floor of the shear rate  [1/s],  > 0; [Z20] uses 1e-3

  double viscosity(double tau_y, double gamma_dot) const { return eta + tau_y / std::max(gamma_dot, gamma_dot_min); }
  /// t = 2 eta' dev(e)                                                     [Z20] Eq. 10, deviator written out
  Dev stress(double tau_y, Dev e, double gamma_dot) const { return 2.0 * viscosity(tau_y, gamma_dot) * e; }
};

}  // namespace talus

#pragma once

#include "math/vec2.hpp"

namespace talus {

/// Pi_ij = (-alpha c mu + beta mu^2)/rho_mean, mu = h v_ij.r_ij/(r^2 + 0.01 h^2), for approaching pairs only.
/// Monaghan 1992, cited by [Z20] Eq. 2.
struct ArtificialViscosity {
  double alpha;  ///< linear coefficient    [-], >= 0
  double beta;   ///< quadratic coefficient [-], >= 0
  double c_s;    ///< speed of sound        [m/s]
  double h;      ///< smoothing length      [m]

  double operator()(double v_dot_r, double r2, double rho_mean) const {
    if (v_dot_r >= 0.0) return 0.0;
    const double mu = h * v_dot_r / (r2 + 0.01 * h * h);
    return (-alpha * c_s * mu + beta * mu * mu) / rho_mean;
  }
};

}  // namespace talus

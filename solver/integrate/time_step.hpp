#pragma once

#include <algorithm>
#include <cmath>

namespace talus {

/// What bounds the explicit step.
struct StepBounds {
  double cfl;  ///< Courant number [-]
  double h;    ///< smoothing length [m]
  double c;    ///< fastest wave [m/s]: compression wave of fluid or of the elastic law
  double nu;   ///< largest eta/rho0 of the materials [m2/s]; eta alone, since the yield stress is bounded
};

/// dt = min(cfl h/(c + |v|), cfl sqrt(h/|a|), 0.125 h^2/nu)       Monaghan 1992; Morris 1997 for the viscous limit
inline double courant_step(const StepBounds& b, double max_speed, double max_acceleration) {
  const double acoustic = b.h / (b.c + max_speed), inertial = std::sqrt(b.h / std::max(max_acceleration, 1e-300));
  const double courant = b.cfl * std::min(acoustic, inertial);
  return b.nu > 0.0 ? std::min(courant, 0.125 * b.h * b.h / b.nu) : courant;
}

}  // namespace talus

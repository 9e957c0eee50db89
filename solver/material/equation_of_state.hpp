#pragma once

#include <cmath>

namespace talus {

/// p = B ((rho/rho0)^chi - 1), chi = 7, B = rho0 c_s^2 / chi              [Z20] Eq. 3
///
/// The paper calls B "the initial pressure" and adds a p0 again in Eq. 10. Here the density starts from the hydrostatic
/// pressure, so that this law alone carries both.
struct EquationOfState {
  double rho0;  ///< reference density [kg/m3], > 0
  double B;     ///< stiffness         [Pa],    > 0

  static EquationOfState weakly_compressible(double rho0, double c_s) { return {rho0, rho0 * c_s * c_s / 7.0}; }

  double pressure(double rho) const {
    const double q = rho / rho0, q2 = q * q, q4 = q2 * q2;
    return B * (q4 * q2 * q - 1.0);
  }
  /// Inverse of pressure(); p > -B.
  double density(double p) const { return rho0 * std::pow(1.0 + p / B, 1.0 / 7.0); }
};

/// Loose soil carries no tension.
constexpr double without_tension(double p) { return p > 0.0 ? p : 0.0; }

}  // namespace talus

#pragma once

#include <cmath>

namespace talus {

/// Exponent chi of the equation of state [-]                              [Z20] Eq. 3
inline constexpr double eos_exponent = 7.0;

/// p = B ((rho/rho0)^chi - 1), chi = 7, B = rho0 c_s^2 / chi              [Z20] Eq. 3
///
/// The paper calls B "the initial pressure" and adds a p0 again in Eq. 10. Here the density starts from the hydrostatic
/// pressure, so that this law alone carries both.
struct EquationOfState {
  double rho0;  ///< reference density [kg/m3], > 0
  double B;     ///< stiffness         [Pa],    > 0

  /// @param c_s  speed of sound at the reference density [m/s], > 0
  static EquationOfState weakly_compressible(double rho0, double c_s) {
    return {rho0, rho0 * c_s * c_s / eos_exponent};
  }

  /// Density of pressure p > -B [Pa]; the pressure of a density is in constitutive_models-inl.hpp.
  double density(double p) const { return rho0 * std::pow(1.0 + p / B, 1.0 / eos_exponent); }

  /// Elastic energy of a unit of mass, the integral of p/rho^2 drho from rho0 [J/kg]:
  /// B/rho0 ((s^6 - 1)/6 + 1/s - 1), s = rho/rho0.
  double energy(double rho) const {
    static_assert(eos_exponent == 7.0);
    const double s = rho / rho0, s3 = s * s * s;
    return B / rho0 * ((s3 * s3 - 1.0) / 6.0 + 1.0 / s - 1.0);
  }
};

}  // namespace talus

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

  /// Density of pressure p > -B [Pa]; the pressure of a density is in equation_of_state-inl.hpp.
  double density(double p) const { return rho0 * std::pow(1.0 + p / B, 1.0 / eos_exponent); }
};

}  // namespace talus

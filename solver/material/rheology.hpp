#pragma once
// How the soil yields: the choices of a run.

#include <optional>

namespace talus {

enum class ShearRate { consistent, paper };  ///< sqrt(2 dev:dev) | sqrt(2/3 dev:dev), [Z20] Eq. 7 as printed
enum class Yield { elastic, regularized };   ///< elasto-viscoplastic | equivalent viscosity, [Z20] Eq. 6

/// The constitutive model and its numerical constants; those of the soil are in Material.
struct Rheology {
  ShearRate shear_rate = ShearRate::consistent;
  Yield yield = Yield::elastic;
  double gamma_dot_min = 1e-3;  ///< floor of the shear rate of the regularised law [1/s], > 0; [Z20] uses 1e-3
  std::optional<double> G;      ///< numerical shear modulus of the elastic law [Pa], > 0; unset: 0.1 rho0 c_s^2
  bool operator==(const Rheology&) const = default;
};

}  // namespace talus

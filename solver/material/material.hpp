#pragma once
// What a soil is made of, and how it yields.

#include <optional>
#include <string>

namespace talus {

/// A Mohr-Coulomb soil that flows as a Bingham fluid, [Z20] Eqs. 3-6.
struct Material {
  std::string name = "soil";
  double rho0 = 2000.0;  ///< reference density                 [kg/m3], > 0
  double phi = 0.0;      ///< friction angle                    [rad],   in [0, pi/2)
  double c = 0.0;        ///< cohesion                          [Pa],    >= 0
  double eta = 0.0;      ///< viscosity once it has yielded     [Pa s],  >= 0
  bool operator==(const Material&) const = default;
};

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

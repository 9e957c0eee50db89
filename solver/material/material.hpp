#pragma once
// What a soil is made of.

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

}  // namespace talus

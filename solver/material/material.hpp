#pragma once
// What a soil is made of, and how it yields.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace talus {

/// Friction that grows with the shear rate, the mu(I) rheology of dry grains; mu_s is the tan(phi) of the yield stress.
/// Without delta_mu and mu_inf there is none. Law and sources: constitutive_models-inl.hpp.
template <class Real = double>
struct InertialFriction {
  Real delta_mu = Real(0.0);  ///< mu_2 - mu_s, how far friction rises   [-],     >= 0
  Real I_0 = Real(0.279);     ///< inertial number of half the rise      [-],     > 0; glass beads, Jop et al. 2006
  Real mu_inf = Real(0.05);   ///< slope of mu(I) at high I              [-],     >= 0; Barker & Gray 2017
  Real d = Real(0.0);         ///< grain diameter                        [m],     >= 0
  Real rho_s = Real(2650.0);  ///< density of the grains                 [kg/m3], > 0; quartz
  bool operator==(const InertialFriction&) const = default;
};

/// The largest viscosity that this friction stands for at pressures up to p [Pa], at any shear rate:
/// sqrt(p rho_s) d max(delta_mu/I_0, mu_inf). [Pa s]
inline double largest_viscosity(const InertialFriction<>& of, double p) {
  return std::sqrt(p * of.rho_s) * of.d * std::max(of.delta_mu / of.I_0, of.mu_inf);
}

/// Loss of strength from peak to residual with plastic shear strain. The residual values are at most the peak ones of
/// each particle. Law: softening.hpp.
struct Softening {
  std::optional<double> phi = {};  ///< residual friction angle [rad], in [0, pi/2); unset: the peak stays
  std::optional<double> c = {};    ///< residual cohesion, or undrained strength [Pa], >= 0; unset: the peak stays
  std::optional<double> displacement = {};  ///< across a shear band until the strength is residual [m], > 0
  std::optional<double> band_width = {};    ///< of a shear band [m], > 0; unset: what the spacing resolves
  std::optional<double> shear_strain = {};  ///< instead of a displacement: plastic shear strain until then [-], > 0
  bool operator==(const Softening&) const = default;
};

/// A Mohr-Coulomb soil, [Z20] Eqs. 3-6, whose resistance to flow grows with the rate as that of a Bingham fluid or by
/// mu(I).
struct Material {
  std::string name = "soil";
  double rho0 = 2000.0;                         ///< reference density                 [kg/m3], > 0
  double phi = 0.0;                             ///< friction angle                    [rad],   in [0, pi/2)
  double c = 0.0;                               ///< cohesion                          [Pa],    >= 0
  double eta = 0.0;                             ///< viscosity once it has yielded     [Pa s],  >= 0
  std::optional<InertialFriction<>> mu_i = {};  ///< instead of a viscosity
  std::optional<double> r_u =
      {};                   ///< pore pressure over total vertical stress [-], in [0, 1]; unset: of the water line
  bool undrained = false;   ///< c is the undrained strength at the ground surface, phi is 0
  double c_gradient = 0.0;  ///< growth of the undrained strength with depth   [Pa/m],  >= 0
  std::optional<Softening> softening = {};
  bool operator==(const Material&) const = default;
};

enum class ShearRate { consistent, paper };  ///< sqrt(2 dev:dev) | sqrt(2/3 dev:dev), [Z20] Eq. 7 as printed
enum class Yield { elastic, regularized };   ///< elasto-viscoplastic | equivalent viscosity, [Z20] Eq. 6

/// Whether the law keeps an elastic stress, whose waves bound the time step.
constexpr bool keeps_elastic_stress(Yield yield) { return yield != Yield::regularized; }

/// The constitutive model and its numerical constants; those of the soil are in Material.
struct Rheology {
  ShearRate shear_rate = ShearRate::consistent;
  Yield yield = Yield::elastic;
  double gamma_dot_min = 1e-3;  ///< floor of the shear rate of the regularised law [1/s], > 0; [Z20] uses 1e-3
  std::optional<double> G;      ///< numerical shear modulus of the elastic law [Pa], > 0; unset: 0.3 rho0 c_s^2
  bool operator==(const Rheology&) const = default;
};

}  // namespace talus

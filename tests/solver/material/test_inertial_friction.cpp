// mu(I) against its formula, written out once more; its limits; its largest viscosity.

#include <gtest/gtest.h>

#include <cmath>

#include "material/constitutive_models-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;

/// Glass beads of Jop, Forterre & Pouliquen 2006.
constexpr double mu_s = 0.3819, mu_2 = 0.6435;  // tan 20.9 and tan 32.76 degrees
constexpr InertialFriction<> beads{.delta_mu = mu_2 - mu_s, .I_0 = 0.279, .mu_inf = 0.0, .d = 0.53e-3, .rho_s = 2450};
constexpr InertialFriction<> regularised{.delta_mu = 0.3, .I_0 = 0.2, .mu_inf = 0.05, .d = 4e-3, .rho_s = 2700};

double inertial_number(const InertialFriction<>& of, double p, double gamma_dot) {
  return gamma_dot * of.d / std::sqrt(p / of.rho_s);
}

/// A particle that keeps the stress at which it yields in simple shear.
struct Yielded {
  Deviator<double> value() const { return {0, 0, 1e6}; }
  void add(Deviator<double>) const {}
  void set_rate(Deviator<double>) const {}
};

/// Shear stress of v_x(y) with dv_x/dy = gamma_dot at a constant pressure.
template <class Model>
double sheared(const InertialFriction<>& of, double p, double c, double gamma_dot) {
  const PointState<double> at{.e = deviatoric_strain_rate(Gradient<double>{0, gamma_dot, 0, 0}),
                              .two_spin = gamma_dot,
                              .gamma_dot = gamma_dot,
                              .p = p,
                              .c = c,
                              .tan_phi = mu_s,
                              .eta = inertial_viscosity(of, p, gamma_dot),
                              .two_G = 0};
  const Deviator<double> t = Model(Rheology{}).stress(at, Yielded{});
  EXPECT_NEAR(magnitude(t), t.xy, 1e-12 * t.xy);
  return t.xy;
}

TEST(InertialFriction, SimpleShearAtConstantPressureGivesMuOfI) {
  for (const InertialFriction<>& of : {beads, regularised})
    for (const double p : {20.0, 5e3, 8e5})
      for (const double gamma_dot : {0.02, 1.5, 40.0, 3e3}) {
        const double I = inertial_number(of, p, gamma_dot);
        const double mu = mu_s + of.delta_mu / (1 + of.I_0 / I) + of.mu_inf * I * I / (of.I_0 + I), c = 150;
        EXPECT_NEAR(sheared<ElastoViscoplastic<double>>(of, p, c, gamma_dot), c + mu * p, 1e-12 * (c + mu * p));
        EXPECT_NEAR(sheared<RegularisedBingham<double>>(of, p, c, gamma_dot), c + mu * p, 1e-12 * (c + mu * p));
      }
}

TEST(InertialFriction, RisesByHalfAtI0AndLevelsOffAtMu2) {
  const double p = 1000, at_I_0 = beads.I_0 * std::sqrt(p / beads.rho_s) / beads.d;
  const auto mu = [&](double gamma_dot) { return sheared<ElastoViscoplastic<double>>(beads, p, 0, gamma_dot) / p; };
  EXPECT_NEAR(mu(at_I_0), (mu_s + mu_2) / 2, 1e-12);
  EXPECT_NEAR(mu(1e-9 * at_I_0), mu_s, 1e-9);
  EXPECT_NEAR(mu(1e9 * at_I_0), mu_2, 1e-9);
}

TEST(InertialFriction, AtHighRatesTheSlopeIsMuInf) {
  const double p = 1000, step = 1e6;
  const auto mu = [&](double gamma_dot) {
    return sheared<ElastoViscoplastic<double>>(regularised, p, 0, gamma_dot) / p;
  };
  EXPECT_NEAR((mu(2 * step) - mu(step)) / inertial_number(regularised, p, step), 0.05, 1e-6);
}

TEST(InertialFriction, IsZeroWithoutPressureAndFiniteAtRest) {
  for (const double p : {0.0, -2e4})
    for (const double gamma_dot : {0.0, 3.0}) EXPECT_EQ(inertial_viscosity(regularised, p, gamma_dot), 0.0);
  EXPECT_DOUBLE_EQ(inertial_viscosity(beads, 4e3, 0.0), std::sqrt(4e3 * 2450) * 0.53e-3 * (mu_2 - mu_s) / 0.279);
  EXPECT_EQ(inertial_viscosity(InertialFriction<>{}, 4e3, 2.0), 0.0) << "a soil without it";
}

TEST(InertialFriction, NoShearRateExceedsTheLargestViscosity) {
  InertialFriction<> steep = regularised;
  steep.mu_inf = 4.0;  // more than delta_mu/I_0: the viscosity is largest at high rates
  for (const InertialFriction<>& of : {beads, regularised, steep}) {
    const double p = 3e4, bound = largest_viscosity(of, p);
    double largest = 0;
    for (double gamma_dot = 1e-6; gamma_dot < 1e12; gamma_dot *= 3) {
      const double eta = inertial_viscosity(of, p, gamma_dot);
      EXPECT_LE(eta, bound * (1 + 1e-12));
      EXPECT_LE(inertial_viscosity(of, 0.5 * p, gamma_dot), bound);
      largest = std::max(largest, eta);
    }
    EXPECT_NEAR(largest, bound, 1e-5 * bound) << "and some shear rate reaches it";
  }
}

}  // namespace
}  // namespace talus

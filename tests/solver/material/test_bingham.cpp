#include <gtest/gtest.h>

#include "material/constitutive_models-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;

constexpr double gamma_dot_min = Rheology{}.gamma_dot_min;

/// Deviatoric strain rate of simple shear v_x = rate * y.
Deviator<double> simple_shear(double rate) { return deviatoric_strain_rate(Gradient<double>{0, rate, 0, 0}); }

/// A model that keeps no stress is given none.
Deviator<double> stress(const PointState<double>& at) {
  return RegularisedBingham<double>(Rheology{}).stress(at, nullptr);
}

/// Stress of simple shear at `rate`.
Deviator<double> shear_stress(ShearRate norm, double eta, double tau_y, double rate) {
  const auto e = simple_shear(rate);
  return stress({.e = e, .two_spin = rate, .gamma_dot = shear_rate(e, norm), .tau_y = tau_y, .eta = eta, .two_G = 0});
}

TEST(Bingham, SimpleShearGivesEq5WithTheConsistentNorm) {
  const double eta = 35, c = 400, tan_phi = 0.47, p = 9000, rate = 2.5;
  EXPECT_NEAR(shear_rate(simple_shear(rate), ShearRate::consistent), rate, 1e-14);
  const auto t = shear_stress(ShearRate::consistent, eta, yield_stress(c, tan_phi, p), rate);
  EXPECT_NEAR(t.xy, eta * rate + c + p * tan_phi, 1e-9);
  EXPECT_NEAR(magnitude(t), t.xy, 1e-9);
}

TEST(Bingham, TheNormAsPrintedMultipliesTheYieldStressBySqrt3) {
  const double eta = 35, c = 400, tan_phi = 0.47, p = 9000, rate = 2.5;
  EXPECT_NEAR(shear_rate(simple_shear(rate), ShearRate::paper), rate / std::numbers::sqrt3, 1e-14);
  const auto t = shear_stress(ShearRate::paper, eta, yield_stress(c, tan_phi, p), rate);
  EXPECT_NEAR(t.xy, eta * rate + std::numbers::sqrt3 * (c + p * tan_phi), 1e-9);
  // A friction angle of 25 degrees acts like 38.9.
  EXPECT_NEAR(std::atan(std::numbers::sqrt3 * std::tan(25 * std::numbers::pi / 180)) * 180 / std::numbers::pi, 38.9,
              0.05);
}

TEST(Bingham, ViscosityIsBoundedAtRest) {
  const RegularisedBingham<double> model(Rheology{});
  EXPECT_DOUBLE_EQ(model.viscosity(2.0, 500.0, 0.0), 2 + 500 / gamma_dot_min);
  EXPECT_DOUBLE_EQ(model.viscosity(2.0, 500.0, 4.0), 2 + 500 / 4.0);
}

TEST(Bingham, TensionGivesNoFriction) { EXPECT_DOUBLE_EQ(yield_stress(300.0, 0.5, -1e4), 300.0); }

TEST(Bingham, UniaxialCompressionUsesTheThreeDimensionalTrace) {
  // L_yy = -a, plane strain: dev = (a/3, -2a/3, a/3 across the plane); sqrt(2 dev:dev) = 2a/sqrt(3).
  const double a = 0.7;
  const auto e = deviatoric_strain_rate(Gradient<double>{0, 0, 0, -a});
  EXPECT_NEAR(e.xx, a / 3, 1e-15);
  EXPECT_NEAR(e.yy, -2 * a / 3, 1e-15);
  EXPECT_NEAR(shear_rate(e, ShearRate::consistent), 2 * a / std::numbers::sqrt3, 1e-14);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include "material/bingham.hpp"

namespace talus {
namespace {

/// Simple shear v_x = rate * y.
Dev simple_shear(double rate) { return deviator(strain_rate({0, rate, 0, 0})); }

TEST(Bingham, SimpleShearGivesEq5WithTheConsistentNorm) {
  const double eta = 35, c = 400, tan_phi = 0.47, p = 9000, rate = 2.5;
  const Dev e = simple_shear(rate);
  EXPECT_NEAR(shear_rate_consistent(e), rate, 1e-14);
  const Dev t = Bingham{eta, 1e-3}.stress(yield_stress(c, tan_phi, p), e, shear_rate_consistent(e));
  EXPECT_NEAR(t.xy, eta * rate + c + p * tan_phi, 1e-9);
  EXPECT_NEAR(magnitude(t), t.xy, 1e-9);
}

TEST(Bingham, TheNormAsPrintedMultipliesTheYieldStressBySqrt3) {
  const double eta = 35, c = 400, tan_phi = 0.47, p = 9000, rate = 2.5;
  const Dev e = simple_shear(rate);
  EXPECT_NEAR(shear_rate_paper(e), rate / std::numbers::sqrt3, 1e-14);
  const Dev t = Bingham{eta, 1e-3}.stress(yield_stress(c, tan_phi, p), e, shear_rate_paper(e));
  EXPECT_NEAR(t.xy, eta * rate + std::numbers::sqrt3 * (c + p * tan_phi), 1e-9);
  // A friction angle of 25 degrees acts like 38.9.
  EXPECT_NEAR(std::atan(std::numbers::sqrt3 * std::tan(25 * std::numbers::pi / 180)) * 180 / std::numbers::pi, 38.9,
              0.05);
}

TEST(Bingham, ViscosityIsBoundedAtRest) {
  EXPECT_DOUBLE_EQ((Bingham{2, 1e-3}.viscosity(500, 0.0)), 2 + 500 / 1e-3);
  EXPECT_DOUBLE_EQ((Bingham{2, 1e-3}.viscosity(500, 4.0)), 2 + 500 / 4.0);
}

TEST(Bingham, TensionGivesNoFriction) { EXPECT_DOUBLE_EQ(yield_stress(300, 0.5, -1e4), 300.0); }

TEST(Bingham, UniaxialCompressionUsesTheThreeDimensionalTrace) {
  // L_yy = -a, plane strain: dev = (a/3, -2a/3, a/3 across the plane); sqrt(2 dev:dev) = 2a/sqrt(3).
  const double a = 0.7;
  const Dev e = deviator(strain_rate({0, 0, 0, -a}));
  EXPECT_NEAR(e.xx, a / 3, 1e-15);
  EXPECT_NEAR(e.yy, -2 * a / 3, 1e-15);
  EXPECT_NEAR(e.zz(), a / 3, 1e-15);
  EXPECT_NEAR(shear_rate_consistent(e), 2 * a / std::numbers::sqrt3, 1e-14);
}

}  // namespace
}  // namespace talus

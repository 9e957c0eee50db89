#include <gtest/gtest.h>

#include <cmath>

#include "material/pore_pressure.hpp"

namespace talus {
namespace {

TEST(PorePressureLaw, SeepageParallelToALineOfFortyFiveDegreesHasHalfTheHydrostaticPressure) {
  EXPECT_DOUBLE_EQ(seepage_pressure(9810, 2.0, 0.0), 9810 * 2.0);
  EXPECT_DOUBLE_EQ(seepage_pressure(9810, 2.0, 1.0), 9810 * 2.0 * 0.5);
  EXPECT_DOUBLE_EQ(seepage_pressure(9810, 2.0, -1.0), 9810 * 2.0 * 0.5);
  EXPECT_EQ(seepage_pressure(9810, -0.1, 1.0), 0.0);
}

TEST(PorePressureLaw, RatioIsOverTheNormalStressOfThePlane) {
  EXPECT_DOUBLE_EQ(pore_pressure_ratio(ratio_pressure(0.3, 5e4), 5e4, 0.0), 0.3);
  EXPECT_DOUBLE_EQ(pore_pressure_ratio(ratio_pressure(0.3, 5e4), 5e4, 1.0), 0.6);
  EXPECT_EQ(pore_pressure_ratio(0.0, 0.0, 1.0), 0.0);
}

TEST(PorePressureLaw, FrictionIsThatOfTheEffectiveStress) {
  // c + (p - u) tan(phi) with u = lambda p
  const double p = 3e4, lambda = 0.4, tan_phi = 0.7;
  EXPECT_DOUBLE_EQ(p * total_stress_friction(tan_phi, lambda), (p - lambda * p) * tan_phi);
  EXPECT_EQ(total_stress_friction(tan_phi, 1.0), 0.0);
  EXPECT_EQ(total_stress_friction(tan_phi, 1.7), 0.0);
}

}  // namespace
}  // namespace talus

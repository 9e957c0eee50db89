// Which of soil and wall yields, by the stress.

#include <gtest/gtest.h>

#include <algorithm>

#include "sph/wall-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;

TEST(WeakerStrength, YieldsAtTheSmallerStressOfSoilAndWall) {
  const MohrCoulomb<double> sand{0, 0.6}, clay{20e3, 0.1}, turbulent{8e3, 0.2}, rough{1e20, 1e6};
  for (const auto& soil : {sand, clay})
    for (const auto& wall : {turbulent, rough})
      for (const double p : {0.0, 1e3, 1.9e4, 5e4, 2e5}) {
        const MohrCoulomb<double> weaker = weaker_strength(soil, wall, p);
        const double at_soil = yield_stress(soil.c, soil.tan_phi, p), at_wall = yield_stress(wall.c, wall.tan_phi, p);
        EXPECT_NEAR(yield_stress(weaker.c, weaker.tan_phi, p), std::min(at_soil, at_wall), 1e-9 * at_soil + 1e-9);
      }
  EXPECT_EQ(weaker_strength(sand, turbulent, -5e3).c, 0.0) << "without pressure sand has no strength";
}

}  // namespace
}  // namespace talus

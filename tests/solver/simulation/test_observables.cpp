#include <gtest/gtest.h>

#include "simulation/observables.hpp"
#include "soil_arrays.hpp"

namespace talus {
namespace {

/// A body of 4 x 3 particles at spacing 1 from x = 2, and a stray one of the given mass at x = 20.
Soil body_and_stray(double stray_mass) {
  Soil s;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 4; ++col) {
      s.x.push_back(2 + col);
      s.y.push_back(row);
    }
  s.x.push_back(20);
  s.y.push_back(0);
  for_each_real(s, [n = s.x.size()](const char*, auto& a) { a.resize(n, 0.0); });
  s.m.assign(13, 1.0);
  s.m.back() = stray_mass;
  s.n_active = 13;
  s.material.assign(13, 0);
  for (int i = 0; i < 13; ++i) s.id.push_back(i);
  return s;
}

TEST(Fronts, FarthestSeesTheStrayParticleTheOthersDoNot) {
  const Measures m = measure_fronts(body_and_stray(0.001), {1.0}, 1.0);
  EXPECT_DOUBLE_EQ(m.influence_zone, 20.0 - 1.0);
  EXPECT_DOUBLE_EQ(m.front_connected, 5.0 - 1.0);
  EXPECT_DOUBLE_EQ(m.front_mass_99, 5.0 - 1.0);
  EXPECT_DOUBLE_EQ(m.front_mass_999, 5.0 - 1.0);  // 0.001 of 12.001 is less than 0.1 %
  EXPECT_NEAR(m.centre_of_mass_x, (12 * 3.5 + 0.001 * 20) / 12.001 - 1.0, 1e-12);
}

TEST(Fronts, AHeavyStrayMovesTheMassFronts) {
  const Measures m = measure_fronts(body_and_stray(0.05), {}, 1.0);  // 0.4 % of the mass
  EXPECT_DOUBLE_EQ(m.front_mass_99, 5.0);
  EXPECT_DOUBLE_EQ(m.front_mass_999, 20.0);
}

TEST(Fronts, LinksReachOneAndAHalfSpacings) {
  Soil s = body_and_stray(0.1);
  s.x.back() = 6.49;
  EXPECT_DOUBLE_EQ(measure_fronts(s, {}, 1.0).front_connected, 6.49);
  s.x.back() = 6.51;
  EXPECT_DOUBLE_EQ(measure_fronts(s, {}, 1.0).front_connected, 5.0);
}

TEST(Fronts, TheLargestBodyIsTheHeaviest) {
  Soil s = body_and_stray(13.0);
  EXPECT_DOUBLE_EQ(measure_fronts(s, {}, 1.0).front_connected, 20.0);
}

TEST(Fronts, OfASlideToTheLeftAreThoseOfItsMirrorImage) {
  const Soil right = body_and_stray(0.05);
  Soil left = right;
  for (double& x : left.x) x = -x;
  const Measures a = measure_fronts(right, {1.5, SlidesTo::right}, 1.0);
  const Measures b = measure_fronts(left, {-1.5, SlidesTo::left}, 1.0);
  for (const Measure& m : measure_table) EXPECT_DOUBLE_EQ(a.*m.member, b.*m.member) << m.key;
  EXPECT_DOUBLE_EQ(b.influence_zone, 20.0 - 1.5);
}

TEST(Energy, MomentumAndSpeeds) {
  Soil s = body_and_stray(2.0);
  s.vx[0] = 3;
  s.vy[12] = -4;
  EXPECT_DOUBLE_EQ(kinetic_energy(s), 0.5 * 9 + 0.5 * 2 * 16);
  EXPECT_DOUBLE_EQ(max_speed(s), 4.0);
  EXPECT_DOUBLE_EQ(rms_speed(s), std::sqrt(2 * (4.5 + 16) / 14));
  s.n_active = 12;  // the last one has left and keeps its velocity
  EXPECT_DOUBLE_EQ(rms_speed(s), std::sqrt(2 * 4.5 / 12));
}

TEST(Digest, DependsOnTheStateNotOnTheOrder) {
  Soil s = body_and_stray(1.0);
  const std::string before = digest(s);
  EXPECT_EQ(before.size(), 16u);
  std::swap(s.x[0], s.x[12]);
  std::swap(s.y[0], s.y[12]);
  std::swap(s.id[0], s.id[12]);
  std::swap(s.m[0], s.m[12]);
  EXPECT_EQ(digest(s), before);
  s.vx[3] = 1e-300;
  EXPECT_NE(digest(s), before);
}

}  // namespace
}  // namespace talus

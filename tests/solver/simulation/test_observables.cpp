#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

const std::vector<Material> unit_density{{.rho0 = 1.0}, {.rho0 = 2.0}};

/// At spacing 1, on an open bed from -100 to 100.
Measures fronts(const Soil& soil, const RunOutAxis& axis = {}, double front_thickness = 1.5) {
  const Terrain terrain{.bed = {{-100, 0}, {100, 0}}, .run_out = axis, .front_thickness = front_thickness};
  return measure_fronts(soil, terrain, 1.0, unit_density);
}

/// Particles of mass 1 at the given places.
Soil soil_at(const std::vector<Vec2>& places) {
  Soil s;
  for (const Vec2& place : places) {
    s.x.push_back(place.x);
    s.y.push_back(place.y);
    s.id.push_back(static_cast<std::int32_t>(s.id.size()));
  }
  for_each_real(s, [n = s.x.size()](const char*, auto& a) { a.resize(n, 0.0); });
  s.m.assign(places.size(), 1.0);
  s.material.assign(places.size(), 0);
  s.n_active = places.size();
  return s;
}

/// A block of particles at spacing 1 on y = 0, from x = first on.
std::vector<Vec2> block(double first, int columns, int rows) {
  std::vector<Vec2> places;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) places.push_back({first + column, row + 0.5});
  return places;
}

TEST(Fronts, FarthestSeesTheStrayParticleTheOthersDoNot) {
  const Measures m = fronts(body_and_stray(0.001), {1.0});
  EXPECT_DOUBLE_EQ(m.influence_zone, 20.0 - 1.0);
  EXPECT_DOUBLE_EQ(m.front_connected, 5.0 - 1.0);
  EXPECT_DOUBLE_EQ(m.front_mass_99, 5.0 - 1.0);
  EXPECT_DOUBLE_EQ(m.front_mass_999, 5.0 - 1.0);  // 0.001 of 12.001 is less than 0.1 %
  EXPECT_NEAR(m.centre_of_mass_x, (12 * 3.5 + 0.001 * 20) / 12.001 - 1.0, 1e-12);
}

TEST(Fronts, AHeavyStrayMovesTheMassFronts) {
  const Measures m = fronts(body_and_stray(0.05));  // 0.4 % of the mass
  EXPECT_DOUBLE_EQ(m.front_mass_99, 5.0);
  EXPECT_DOUBLE_EQ(m.front_mass_999, 20.0);
}

TEST(Fronts, LinksReachOneAndAHalfSpacings) {
  Soil s = body_and_stray(0.1);
  s.x.back() = 6.49;
  EXPECT_DOUBLE_EQ(fronts(s).front_connected, 6.49);
  s.x.back() = 6.51;
  EXPECT_DOUBLE_EQ(fronts(s).front_connected, 5.0);
}

TEST(Fronts, TheLargestBodyIsTheHeaviest) {
  Soil s = body_and_stray(13.0);
  EXPECT_DOUBLE_EQ(fronts(s).front_connected, 20.0);
}

TEST(Fronts, OfASlideToTheLeftAreThoseOfItsMirrorImage) {
  const Soil right = body_and_stray(0.05);
  Soil left = right;
  for (double& x : left.x) x = -x;
  const Measures a = fronts(right, {1.5, SlidesTo::right});
  const Measures b = fronts(left, {-1.5, SlidesTo::left});
  for (const Measure& m : measure_table) EXPECT_DOUBLE_EQ(a.*m.member, b.*m.member) << m.key;
  EXPECT_DOUBLE_EQ(b.influence_zone, 20.0 - 1.5);
}

TEST(FrontAtThickness, IsThatOfTheLargestBody) {
  std::vector<Vec2> places = block(0.5, 20, 4);
  const double alone = fronts(soil_at(places)).front_at_thickness;
  EXPECT_NEAR(alone, 20.0, 1.0);
  std::vector<Vec2> second = block(22.5, 10, 3);  // 3 spacings from the last column of the first
  places.insert(places.end(), second.begin(), second.end());
  const Measures apart = fronts(soil_at(places));
  EXPECT_EQ(apart.front_at_thickness, alone);
  EXPECT_EQ(apart.influence_zone, 31.5);
  places.push_back({21.0, 0.5});  // links the two
  const Measures linked = fronts(soil_at(places));
  EXPECT_NEAR(linked.front_at_thickness, 32.0, 1.0);
  EXPECT_EQ(fronts(soil_at(block(22.5, 10, 3))).front_at_thickness, linked.front_at_thickness);
}

TEST(FrontAtThickness, OnASlopeIsMeasuredVertically) {
  // On a bed that falls at the angle a, soil of the normal thickness n = n0 - b q at the distance q along the bed:
  // its surface at x = q cos a + n sin a is n/cos a above the bed.
  const double a = std::numbers::pi / 6.0, n0 = 12.0, b = 0.2, t = 6.0;
  std::vector<Vec2> places;
  std::vector<double> masses;
  for (double q = 0.5; q < n0 / b; q += 1.0) {
    const double height = n0 - b * q;
    for (double n = 0.0; n < height; n += 1.0) {
      const double cut = std::min(1.0, height - n), middle = n + 0.5 * cut;
      places.push_back({q * std::cos(a) + middle * std::sin(a), -q * std::sin(a) + middle * std::cos(a)});
      masses.push_back(cut);
    }
  }
  Soil soil = soil_at(places);
  soil.m = masses;
  const double n = t * std::cos(a), q = (n0 - n) / b;
  EXPECT_NEAR(fronts(soil, {}, t).front_at_thickness, q * std::cos(a) + n * std::sin(a), 0.1);
}

TEST(FrontAtThickness, IsOfSoilAtItsReferenceDensity) {
  Soil soil = soil_at(block(0.5, 20, 3));
  const double front = fronts(soil).front_at_thickness;
  soil.rho.assign(soil.size(), 0.3);  // loosened
  EXPECT_EQ(fronts(soil).front_at_thickness, front);
  soil.material.assign(soil.size(), 1);  // twice as dense
  EXPECT_EQ(fronts(soil, {}, 0.75).front_at_thickness, front);
}

TEST(FrontAtThickness, LeavesOutSoilThatLeftTheTerrain) {
  std::vector<Vec2> places = block(0.5, 20, 4);
  const Measures all = fronts(soil_at(places));
  for (int k = 0; k < 30; ++k) places.push_back({20.5 + 0.01 * k, 0.5});  // they left where the bed ends
  Soil soil = soil_at(places);
  soil.n_active = 80;
  const Measures measures = fronts(soil);
  EXPECT_EQ(measures.front_at_thickness, all.front_at_thickness);
  Terrain terrain;
  terrain.bed = {{0, 0}, {20.5, 0}};
  // The front lies before the end, but the body goes on beyond it.
  const std::vector<std::string> bounds = lower_bounds(soil, terrain, measures);
  EXPECT_LT(measures.front_at_thickness, 20.5);
  EXPECT_NE(std::ranges::find(bounds, "front_at_thickness_m"), bounds.end());
  const std::vector<std::string> without = lower_bounds(soil, terrain, fronts(soil, {}, 50.0));
  EXPECT_EQ(std::ranges::find(without, "front_at_thickness_m"), without.end()) << "no value, so no bound";
  for (std::size_t i = 80; i < soil.size(); ++i) soil.x[i] += 5.0;  // they are not of the body
  EXPECT_EQ(
      lower_bounds(soil, terrain, fronts(soil)),
      (std::vector<std::string>{"influence_zone_m", "front_mass_99_m", "front_mass_999_m", "centre_of_mass_x_m"}));
}

TEST(FrontAtThickness, WithoutSoilSoThickIsNoneAndANoteSaysSo) {
  const Measures measures = fronts(soil_at(block(0.5, 20, 1)));
  EXPECT_TRUE(std::isnan(measures.front_at_thickness));
  const std::vector<std::string> notes = notes_on(measures, 1.5, 1.0);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("nowhere 1.5 m thick"), std::string::npos) << notes[0];
}

TEST(Notes, NameParticlesThatWereThrownAhead) {
  Measures m{.influence_zone = 30, .front_connected = 24.9, .front_mass_99 = 20, .front_at_thickness = 19};
  ASSERT_EQ(notes_on(m, 1.5, 1.0).size(), 1u);
  EXPECT_NE(notes_on(m, 1.5, 1.0)[0].find("10 m ahead of the front of 99 % of the mass and 5.1 m ahead"),
            std::string::npos)
      << notes_on(m, 1.5, 1.0)[0];
  m.front_connected = 25.1;  // less than 5 spacings
  EXPECT_TRUE(notes_on(m, 1.5, 1.0).empty());
  m.front_connected = 20;
  m.front_mass_99 = 25.1;  // more than 1 % of the mass is there
  ASSERT_EQ(notes_on(m, 1.5, 1.0).size(), 1u);
  EXPECT_EQ(notes_on(m, 1.5, 1.0)[0],
            "the front of 99 % of the mass lies 5.1 m ahead of the connected body: more than 1 % of the soil is "
            "separate from it");
  m.front_mass_99 = 24.9;
  m.influence_zone = 29;
  EXPECT_TRUE(notes_on(m, 1.5, 1.0).empty());
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

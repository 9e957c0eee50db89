#include <gtest/gtest.h>

#include <limits>

#include "random_soil.hpp"
#include "sph/wall-inl.hpp"

namespace talus {
namespace {

using namespace testing_support;
using namespace HWY_NAMESPACE;

TEST(Wall, MirroredVelocityVanishesOnTheWallLine) {
  // Linear between soil (d_i above, v) and wall particle (d_j below, v - b v): zero at the line when b = 1 + d_j/d_i.
  const double d_i = 0.3, d_j = 0.1, b = mirror_ratio(d_i, d_j, 99.0), v = 2.0;
  const double v_wall = v - b * v;
  EXPECT_NEAR(v_wall + (v - v_wall) * d_j / (d_i + d_j), 0.0, 1e-15);
}

TEST(Wall, MirrorRatioIsCapped) {
  EXPECT_DOUBLE_EQ(mirror_ratio(0.1, 0.3, 1.5), 1.5);
  EXPECT_DOUBLE_EQ(mirror_ratio(-0.1, 0.3, 1.5), 1.5);
  EXPECT_DOUBLE_EQ(mirror_ratio(0.0, 0.3, 1.5), 1.5);
}

TEST(Wall, SmoothWallKeepsTheTangentialVelocity) {
  const Vector<double> n{0.6, 0.8}, t{-0.8, 0.6}, v{3, 1};
  const auto smooth = wall_relative_velocity(v, n, 1.4, true), rough = wall_relative_velocity(v, n, 1.4, false);
  EXPECT_NEAR(dot(smooth, t), 0.0, 1e-15);
  EXPECT_NEAR(dot(smooth, n), 1.4 * dot(v, n), 1e-15);
  EXPECT_EQ(rough.x, 1.4 * v.x);
  EXPECT_EQ(rough.y, 1.4 * v.y);
}

TEST(Wall, InterfaceYieldsAtTheSmallerAngleAndTheSmallerCohesion) {
  const MohrCoulomb<double> clay{5000, 0.2}, sand{100, 0.5};
  const auto weaker = interface_strength(clay, sand, true), outside = interface_strength(clay, sand, false);
  EXPECT_DOUBLE_EQ(weaker.c, 100);
  EXPECT_DOUBLE_EQ(weaker.tan_phi, 0.2);
  EXPECT_DOUBLE_EQ(interface_strength(sand, clay, true).c, 100);
  EXPECT_DOUBLE_EQ(interface_strength(sand, clay, true).tan_phi, 0.2);
  EXPECT_DOUBLE_EQ(outside.c, 5000);
  EXPECT_DOUBLE_EQ(outside.tan_phi, 0.2);
}

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Wall, ExtrapolationIsExactForHydrostaticPressure) {
  // p = p0 - rho |g| y in the soil continues into the wall with the same slope.
  const Vector<double> g{0, -9.81}, wall{0.0, -0.05};
  auto sum = WallStressSum<double>::zero();
  for (const Vector<double> x : {Vector<double>{0.02, 0.05}, {-0.1, 0.05}, {0.04, 0.15}}) {
    const double p = 5000 - 2000 * 9.81 * x.y;
    sum.add(1.0 / (1.0 + dot(x, x)), {{-p, -p, 0}, p, 2000, 0, 1000, 0.5}, dot(g, wall - x), 1.0 / (50 * 50));
  }
  EXPECT_NEAR(sum.p / sum.weight, 5000 + 2000 * 9.81 * 0.05, 1e-9);
  EXPECT_NEAR(sum.value(constants(0.1, {0, -9.81}, {}), {0, 1}, {infinity, infinity}, false).p,
              5000 + 2000 * 9.81 * 0.05, 1e-9);
}

TEST(Wall, HoldsNoSoilUpThatBearsNoPressure) {
  const auto pressure_at_wall = [](double p) {
    auto sum = WallStressSum<double>::zero();
    sum.add(0.7, {{-p, -p, 0}, p, 2000, 0, 0, 0.5}, 9.81 * 0.1, 1e-4);  // 1962 Pa of weight on the way
    return sum.value(constants(0.1, {0, -9.81}, {}), {0, 1}, {infinity, infinity}, false).p;
  };
  EXPECT_EQ(pressure_at_wall(0.0), 0.0);
  EXPECT_NEAR(pressure_at_wall(300.0), 6.0 * 300.0, 1e-9);
  EXPECT_NEAR(pressure_at_wall(400.0), 400.0 + 1962.0, 1e-9);
}

TEST(Wall, DeviatorGrowsWithThePressureUpToTheYieldStress) {
  // size, pressure at the wall and in the soil, yield stress at these
  EXPECT_DOUBLE_EQ(deviator_growth(20.0, 150.0, 100.0, 75.0, 50.0), 1.5);   // does not yield
  EXPECT_DOUBLE_EQ(deviator_growth(50.0, 900.0, 100.0, 450.0, 50.0), 6.0);  // friction alone, yields
  EXPECT_DOUBLE_EQ(deviator_growth(40.0, 900.0, 100.0, 40.0, 40.0), 1.0);   // cohesion alone, yields
  EXPECT_DOUBLE_EQ(deviator_growth(25.0, 900.0, 100.0, 40.0, 40.0), 1.6);   // cohesion alone, yields at the wall
  EXPECT_DOUBLE_EQ(deviator_growth(20.0, -5.0, 100.0, 40.0, 40.0), 0.0);
  EXPECT_DOUBLE_EQ(deviator_growth(20.0, 50.0, 0.0, 40.0, 40.0), 1.0);
  EXPECT_DOUBLE_EQ(deviator_growth(0.0, 50.0, 20.0, 40.0, 40.0), 1.0);
}
TEST(Wall, ViscousStressGrowsWithThePressureUpToSixfold) {
  EXPECT_DOUBLE_EQ(deviator_growth(20.0, 150.0, 100.0, 0.0, 0.0), 1.5);
  EXPECT_DOUBLE_EQ(deviator_growth(20.0, 900.0, 100.0, 0.0, 0.0), 6.0);
  EXPECT_DOUBLE_EQ(deviator_growth(70.0, 900.0, 100.0, 450.0, 50.0), (300.0 + 6.0 * 20.0) / 70.0);
}

TEST(Wall, ShearAtTheWallIsTheYieldStressOfTheSoilThere) {
  // All of the soil yields: sxy = c + p tan(phi), whatever the pressures.
  const double c = 800, tan_phi = 0.4;
  auto sum = WallStressSum<double>::zero();
  for (const double p : {1000.0, 3000.0, 5000.0})
    sum.add(1.0, {{-p, -p, c + p * tan_phi}, p, 2000, 0, c, tan_phi}, 9.81 * 0.1, 1e-4);
  const WallStress<double> wall = sum.value(constants(0.1, {0, -9.81}, {}), {0, 1}, {infinity, infinity}, false);
  EXPECT_DOUBLE_EQ(wall.p, 3000 + 2000 * 9.81 * 0.1);
  EXPECT_NEAR(wall.s.xy, c + wall.p * tan_phi, 1e-9);
  const WallStress<double> smoother = sum.value(constants(0.1, {0, -9.81}, {}), {0, 1}, {300, 0.1}, false);
  EXPECT_NEAR(smoother.s.xy, 300 + wall.p * 0.1, 1e-9);
  // Of two strengths each may be the weaker one.
  const WallStress<double> less_cohesive = sum.value(constants(0.1, {0, -9.81}, {}), {0, 1}, {300, 0.9}, false);
  EXPECT_NEAR(less_cohesive.s.xy, 300 + wall.p * tan_phi, 1e-9);
}

/// Soil sliding along a flat wall at 3 m/s under pressure; returns it evaluated.
Soil sliding(WallSlip slip, double phi_wall) {
  const double dx = 0.1;
  FlowConstants k = constants(dx, {0, 0}, {{"a", 2000, 0.5, 0, 0}});
  k.boundaries = wall_friction(std::vector{Boundary{"bed", {}, slip, phi_wall}});
  k.rheology.yield = Yield::regularized;
  k.numerics.density_filter = DensityFilter::none;
  k.numerics.alpha = 0;
  Soil soil = random_soil(20, 8, dx, 3);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    soil.x[i] = static_cast<double>(i % 20) * dx;
    soil.y[i] = static_cast<double>(i / 20) * dx;
    soil.vx[i] = 3;
    soil.vy[i] = 0;
    soil.m[i] = 2000 * dx * dx;
    soil.tan_phi[i] = 0.5;
    soil.c[i] = 0;
    soil.rho[i] = k.soils[0].eos.density(1e4);
  }
  WallParticles walls = flat_walls(20, dx);
  const CellList soil_cells = sorted(soil, 2 * k.h), wall_cells = sorted(walls, 2 * k.h);
  evaluate(k, soil, walls, soil_cells, wall_cells);
  return soil;
}

/// Drag on the lowest two rows in the middle third, per metre of wall [Pa].
double traction(const Soil& s) {
  double force = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    if (s.id[i] % 20 >= 7 && s.id[i] % 20 < 13 && s.id[i] / 20 < 4) force += s.m[i] * s.ax[i];
  return force / (6 * 0.1);
}

TEST(Wall, RoughWallDragsAtMohrCoulomb) {
  EXPECT_NEAR(traction(sliding(WallSlip::no_slip, 0)), -1e4 * 0.5, 0.15 * 1e4 * 0.5);
}

TEST(Wall, FrictionOfTheWallScalesTheDrag) {
  const double rough = traction(sliding(WallSlip::no_slip, 0)),
               smoother = traction(sliding(WallSlip::friction, std::atan(0.2)));
  EXPECT_LT(smoother, 0.0);
  EXPECT_NEAR(smoother / rough, 0.2 / 0.5, 0.2);  // the second row still shears a little at the soil's own angle
}

TEST(Wall, FreeSlipDragsNothing) { EXPECT_NEAR(traction(sliding(WallSlip::free_slip, 0)), 0.0, 1e-6); }

}  // namespace
}  // namespace talus

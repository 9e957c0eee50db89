// Undrained strength with a depth trend: the infinite slope, and a vertical cut.

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/pore_pressure.hpp"
#include "slabs.hpp"

namespace talus {
namespace {

using namespace testing_support;

Material clay(double strength, double gradient) {
  Material m{"clay", 1800, 0, strength, 0};
  m.undrained = true;
  m.c_gradient = gradient;
  return m;
}

TEST(Undrained, StrengthGrowsWithTheDepthBelowTheGround) {
  Model m = column(2.0, 2.0, 0.5);
  m.slide[0].outline = {{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {0, 1}};  // the ground is 1 m lower on the left
  m.materials = {clay(5000, 1500)};
  const ParticlePlan plan = plan_particles(m);
  const SoilProperties of = material_properties(m, plan);
  ASSERT_EQ(of.c.size(), plan.soil.size());
  for (std::size_t i = 0; i < of.c.size(); ++i) {
    const Vec2 x = plan.soil[i].x;
    EXPECT_NEAR(of.c[i], 5000 + 1500 * ((x.x < 1.0 ? 1.0 : 2.0) - x.y), 1e-9);
    EXPECT_EQ(of.tan_phi[i], 0.0);
  }
}

TEST(Undrained, KeepsNoFrictionWhateverAFieldDraws) {
  Model m = column(1.0, 1.0, 0.25);
  m.materials = {clay(5000, 0)};
  const ParticlePlan plan = plan_particles(m);
  SoilProperties drawn = material_properties(m, plan);
  drawn.tan_phi.assign(drawn.tan_phi.size(), 0.4);
  const Simulation simulation(m, plan, drawn);
  for (const double tan_phi : simulation.soil().tan_phi) EXPECT_EQ(tan_phi, 0.0);
}

// The infinite slope: tau = gamma H sin(beta) cos(beta) at the base against c_u0 + k H.
constexpr Slab slope{20 * degree, 60.0, 2.5, 0.25};

double base_strength(double safety) {
  return safety * 1800 * standard_gravity * slope.depth() * std::sin(slope.theta) * std::cos(slope.theta);
}
/// Half of the strength at the base is that of the ground surface.
Model slope_of(double safety) {
  Model m = slope.model(5.0);
  m.materials = {clay(0.5 * base_strength(safety), 0.5 * base_strength(safety) / slope.depth())};
  return m;
}

TEST(Undrained, InfiniteSlopeStandsAboveASafetyOfOneAndSlidesBelow) {
  EXPECT_NEAR(late_acceleration(slope, slope_of(1.08), 2.0), 0.0, 0.1);  // it swings a little
  const double found = resistance(slope, late_acceleration(slope, slope_of(0.8), 1.5));
  EXPECT_NEAR(found / (0.8 * std::sin(slope.theta)), 1.0, 0.04);
}

}  // namespace
}  // namespace talus

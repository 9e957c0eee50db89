// Pore pressure: the ratio at a point against closed forms, and the infinite slope with seepage.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/pore_pressure.hpp"
#include "slabs.hpp"

namespace talus {
namespace {

using namespace testing_support;

const Material sand{"sand", 2000, 40 * degree, 0, 0};

Material with_r_u(double r_u) {
  Material m = sand;
  m.r_u = r_u;
  return m;
}

/// A slope of 30 degrees, ten rows thick.
constexpr Slab slope{30 * degree, 60.0, 2.5, 0.25};

/// Its water line, parallel to the ground, `depth` below it vertically [m].
std::vector<Vec2> parallel_line(double depth) {
  return {slope.at(-5, slope.thickness) - Vec2{0, depth}, slope.at(slope.length + 5, slope.thickness) - Vec2{0, depth}};
}

Model slope_of(const Material& material, std::vector<Vec2> line = {}) {
  Model m = slope.model(5.0);
  m.materials = {material};
  m.water.line = std::move(line);
  return m;
}

/// Of a point in the middle of the slope, at a height above its bed [m].
double ratio_at(const Model& m, double height) {
  return pore_pressure_ratios(m, std::vector<SoilPoint>{{slope.at(0.5 * slope.length, height), 0}}).at(0);
}

TEST(PorePressure, RatioOfTheInfiniteSlopeIsRuOverTheSquaredCosine) {
  const double cos2 = 0.75;  // of 30 degrees
  for (const double height : {0.1, 1.0, 2.4}) EXPECT_NEAR(ratio_at(slope_of(with_r_u(0.3)), height), 0.3 / cos2, 1e-9);
}

TEST(PorePressure, OnLevelGroundTheRatioIsRu) {
  Model m = column(20.0, 4.0, 0.5);
  m.materials[0].r_u = 0.35;
  for (const double lambda : pore_pressure_ratios(m, plan_particles(m).soil)) EXPECT_NEAR(lambda, 0.35, 1e-12);
}

TEST(PorePressure, BelowAParallelLineItIsThatOfSeepageAndAboveItTheSoilIsDry) {
  const double line_depth = 1.0;  // below the ground
  const Model m = slope_of(sand, parallel_line(line_depth));
  const double H = slope.depth();
  for (const double below : {1.2, 2.0, H}) {  // vertical depth of the point
    const double height = (H - below) * std::cos(slope.theta);
    EXPECT_NEAR(ratio_at(m, height), 1000.0 * (below - line_depth) / (2000.0 * below), 1e-6) << below;
  }
  EXPECT_EQ(ratio_at(m, slope.thickness - 0.8 * std::cos(slope.theta)), 0.0);
}

TEST(PorePressure, UnderALevelLineItIsHydrostatic) {
  Model m = column(20.0, 4.0, 0.5);
  m.water.line = {{-1, 3.0}, {21, 3.0}};
  const std::vector<SoilPoint> points{{{10.0, 1.0}, 0}, {{10.0, 3.5}, 0}};
  const std::vector<double> lambda = pore_pressure_ratios(m, points);
  EXPECT_NEAR(lambda[0], 1000.0 * 2.0 / (2000.0 * 3.0), 1e-12);
  EXPECT_EQ(lambda[1], 0.0);
  m.water.density = 1200.0;
  EXPECT_NEAR(pore_pressure_ratios(m, points)[0], 1200.0 * 2.0 / (2000.0 * 3.0), 1e-12);
}

TEST(PorePressure, AMaterialsOwnRatioComesBeforeTheLineAndUndrainedSoilHasNone) {
  EXPECT_EQ(ratio_at(slope_of(with_r_u(0.0), parallel_line(0.0)), 0.5), 0.0);
  EXPECT_NEAR(ratio_at(slope_of(with_r_u(0.15), parallel_line(0.0)), 0.5), 0.2, 1e-9);
  Material clay{"clay", 2000, 0, 20e3, 0};
  clay.undrained = true;
  EXPECT_EQ(ratio_at(slope_of(clay, parallel_line(0.0)), 0.5), 0.0);
  EXPECT_FALSE(has_pore_pressure(slope_of(clay, parallel_line(0.0))));
}

TEST(PorePressure, StressIsThatOfAllLayersAbove) {
  Model m = column(20.0, 4.0, 0.5);
  m.slide = {{{{0, 0}, {20, 0}, {20, 2}, {0, 2}}, 0}, {{{0, 2}, {20, 2}, {20, 4}, {0, 4}}, 1}};
  m.materials = {sand, {"light", 1000, 30 * degree, 0, 0}};
  m.water.line = {{-1, 3.0}, {21, 3.0}};
  const double sigma_v = 1000.0 * 2.0 + 2000.0 * 1.0;
  EXPECT_NEAR(pore_pressure_ratios(m, std::vector<SoilPoint>{{{10.0, 1.0}, 0}})[0], 1000.0 * 2.0 / sigma_v, 1e-12);
}

TEST(PorePressure, AStepInTheGroundIsNoSlope) {
  // Level ground with a step of 1 m in 0.1 m: a point 3 m deep sees a chord of 6 m, tan = 1/6.
  Model m = column(20.0, 4.0, 0.5);
  m.slide[0].outline = {{0, 0}, {20, 0}, {20, 3}, {10.1, 3}, {10, 4}, {0, 4}};
  m.materials[0].r_u = 0.3;
  const double lambda = pore_pressure_ratios(m, std::vector<SoilPoint>{{{10.05, 0.5}, 0}})[0];
  EXPECT_NEAR(lambda, 0.3 * (1.0 + 1.0 / 36.0), 1e-3);
}

TEST(PorePressure, LiquefiedSoilHasNoFrictionAndIsCounted) {
  const Model m = slope_of(with_r_u(0.8));  // 0.8/0.75 > 1
  const ParticlePlan plan = plan_particles(m);
  const PorePressureSummary water = summary_of(pore_pressure_ratios(m, plan.soil));
  EXPECT_EQ(water.wet, static_cast<std::int64_t>(plan.soil.size()));
  EXPECT_GT(water.liquefied, water.wet * 9 / 10);
  Simulation simulation(m, plan);
  EXPECT_EQ(std::ranges::min(simulation.soil().tan_phi), 0.0);
}

// Factor of safety of the infinite slope: (1 - r_u/cos^2(beta)) tan(phi)/tan(beta).
double factor_of_safety(double r_u) { return (1.0 - r_u / 0.75) * std::tan(40 * degree) / std::tan(30 * degree); }

TEST(PorePressure, InfiniteSlopeStandsAboveASafetyOfOneAndSlidesBelow) {
  const double of_one = 0.75 * (1.0 - std::tan(30 * degree) / std::tan(40 * degree));
  EXPECT_NEAR(factor_of_safety(of_one), 1.0, 1e-12);
  const double stands = 0.85 * of_one, slides = 1.15 * of_one;                       // safety 1.07 and 0.93
  EXPECT_NEAR(late_acceleration(slope, slope_of(with_r_u(stands)), 2.0), 0.0, 0.1);  // it swings a little
  const double found = resistance(slope, late_acceleration(slope, slope_of(with_r_u(slides)), 1.5));
  EXPECT_NEAR(found / (std::sin(slope.theta) * factor_of_safety(slides)), 1.0, 0.03);
}

TEST(PorePressure, SeepageAtHalfTheThicknessTakesAQuarterOfTheFriction) {
  // u = gamma_w (H/2) cos^2, sigma_n = gamma H cos^2. Resistance over weight: cos (1 - 1/4) tan(phi).
  Material weak = sand;
  weak.phi = 32 * degree;
  const Model m = slope_of(weak, parallel_line(0.5 * slope.depth()));
  const double found = resistance(slope, late_acceleration(slope, m, 1.5));
  EXPECT_NEAR(found / (std::cos(slope.theta) * 0.75 * std::tan(32 * degree)), 1.0, 0.04);
}

TEST(PorePressure, TheRunsFrictionIsThatOfTotalStressAndTheEnergyLineFollows) {
  const Model m = slope_of(with_r_u(0.3));
  Simulation simulation(m, plan_particles(m));
  const double expected = (1.0 - 0.3 / 0.75) * std::tan(40 * degree);
  std::vector<double> tan_phi = simulation.soil().tan_phi;
  std::ranges::nth_element(tan_phi, tan_phi.begin() + static_cast<std::ptrdiff_t>(tan_phi.size() / 2));
  EXPECT_NEAR(tan_phi[tan_phi.size() / 2], expected, 1e-9);
  EXPECT_LE(*simulation.facts().least_friction, expected * (1.0 + 1e-12));
}

}  // namespace
}  // namespace talus

// What the checks on friction and on the thickness of the flow are told, against counts by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// A box of 1 m by 0.8 m at a spacing of 0.1 m, its state changed.
template <class Change>
RunFacts facts_of_box(const Model& m, const Change& change) {
  Simulation simulation(m, plan_particles(m));
  CheckpointState state = simulation.state();
  change(state);
  simulation.restore(state);
  return simulation.facts();
}

RunFacts facts_with_head(double head) {
  return facts_of_box(column(1.0, 0.8, 0.1),
                      [&](CheckpointState& s) { std::ranges::fill(s.reals["vx"], std::sqrt(2.0 * 9.81 * head)); });
}

// The line rises from both top corners with tan(25 deg): 0.8 m + 0.4663 x up to the middle. The particles of the top
// row, at 0.75 m, are 0.05 m + 0.4663 x below it, x = 0.05, 0.15 ... 0.45 m; those of the next 0.1 m more.
TEST(FrictionFacts, SoilIsCountedThatIsMoreThanASpacingAboveTheEnergyLine) {
  const double t = std::tan(25 * degree);
  EXPECT_EQ(*facts_with_head(0.0).least_friction, t);
  EXPECT_EQ(facts_with_head(0.0).beyond_energy_line, 0.0);
  EXPECT_EQ(facts_with_head(0.149 + 0.05 * t).beyond_energy_line, 0.0);
  EXPECT_NEAR(facts_with_head(0.151 + 0.05 * t).beyond_energy_line, 2.0 / 80.0, 1e-12);
  EXPECT_NEAR(facts_with_head(0.149 + 0.15 * t).beyond_energy_line, 2.0 / 80.0, 1e-12);
  EXPECT_NEAR(facts_with_head(0.151 + 0.15 * t).beyond_energy_line, 4.0 / 80.0, 1e-12);
  EXPECT_NEAR(facts_with_head(2.0).beyond_energy_line, 1.0, 1e-12);
}

TEST(FrictionFacts, TravelIsTheMeanDistanceAlongX) {
  const RunFacts f = facts_of_box(column(1.0, 0.8, 0.1), [](CheckpointState& s) {
    for (std::size_t i = 0; i < s.reals["x"].size(); ++i) s.reals["x"][i] += i % 2 == 0 ? 0.02 : -0.04;
  });
  EXPECT_NEAR(f.travel, 0.03, 1e-9);
}

TEST(FrictionFacts, TheLeastFrictionIsThatOfAnyParticleOrWall) {
  Model m = column(1.0, 0.8, 0.1);
  const ParticlePlan plan = plan_particles(m);
  SoilProperties drawn = material_properties(m, plan);
  drawn.tan_phi[7] = 0.1;
  EXPECT_EQ(*Simulation(m, plan, drawn).facts().least_friction, 0.1);
  m.boundaries[0].slip = WallSlip::friction;
  m.boundaries[0].phi = std::atan(0.05);
  EXPECT_NEAR(*Simulation(m, plan, drawn).facts().least_friction, 0.05, 1e-15);
  m.boundaries[0].slip = WallSlip::free_slip;
  EXPECT_FALSE(Simulation(m, plan, drawn).facts().least_friction) << "nothing bounds the run-out";
  m.boundaries[0].slip = WallSlip::no_slip;
  m.g.x = 1.0;
  EXPECT_FALSE(Simulation(m, plan, drawn).facts().least_friction) << "the line is that of vertical gravity";
}

TEST(FrictionFacts, MassIsComparedWithTheOutlines) {
  Model m = column(1.0, 0.8, 0.1);
  EXPECT_NEAR(Simulation(m, plan_particles(m)).facts().mass_change, 0.0, 1e-12);
  m.placement = Placement::nodes;  // up to 11 by 9 cells
  const ParticlePlan plan = plan_particles(m);
  EXPECT_GT(plan.soil.size(), 90u);
  EXPECT_NEAR(Simulation(m, plan).facts().mass_change, static_cast<double>(plan.soil.size()) / 80.0 - 1.0, 1e-12);
}

constexpr double dx = 0.5;
const std::vector<Material> two_soils{{"soil", 2000, 0.4, 0, 0}, {"light soil", 1000, 0.4, 0, 0}};

/// `rows` rows of four particles from x on, which move at v.
void add_layer(Soil& soil, double x, int rows, double v, int material = 0) {
  const double rho0 = two_soils[static_cast<std::size_t>(material)].rho0;
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < 4; ++k) {
      soil.x.push_back(x + (k + 0.5) * dx);
      soil.y.push_back((row + 0.5) * dx);
      soil.vx.push_back(0.6 * v);
      soil.vy.push_back(-0.8 * v);
      soil.m.push_back(rho0 * dx * dx);
      soil.material.push_back(material);
    }
  soil.n_active = soil.x.size();
}

double mean_of(const Soil& soil) {
  FlowThickness flow;
  flow.observe(soil, two_soils, dx, 1.0);
  return flow.mean().value_or(-1.0);
}

TEST(FlowThickness, IsThatOfTheSoilThatMoves) {
  Soil soil;
  add_layer(soil, 0.0, 3, 0.0);
  EXPECT_EQ(mean_of(soil), -1.0) << "nothing moves";
  add_layer(soil, 2.0, 5, 2.0, 1);
  EXPECT_NEAR(mean_of(soil), 5.0, 1e-12);
  add_layer(soil, -2.0, 2, 10.0);  // momentum of 2 rows 2000 * 10, of 5 rows 1000 * 2
  EXPECT_NEAR(mean_of(soil), (5.0 * 5 * 2 + 2.0 * 2 * 20) / (5 * 2 + 2 * 20), 1e-12);
  soil.n_active = 12 + 20;
  EXPECT_NEAR(mean_of(soil), 5.0, 1e-12) << "what has left the terrain";
}

TEST(FlowThickness, IsAMeanOverTime) {
  Soil thick, thin;
  add_layer(thick, 0.0, 6, 1.0);
  add_layer(thin, 0.0, 2, 4.0);
  FlowThickness flow;
  flow.observe(thick, two_soils, dx, 3.0);
  FlowThickness resumed;
  resumed.restore(flow.state());
  for (FlowThickness* one : {&flow, &resumed}) {
    one->observe(thin, two_soils, dx, 5.0);
    EXPECT_NEAR(*one->mean(), (6.0 * 6 * 1 * 3 + 2.0 * 2 * 4 * 2) / (6 * 1 * 3 + 2 * 4 * 2), 1e-12);
  }
}

TEST(FlowThickness, OutlastsACheckpoint) {
  const Model m = collapse(0.1);
  Simulation whole(m, plan_particles(m)), resumed(m, plan_particles(m));
  while (whole.steps() < 250) whole.step(m.time.end);
  resumed.restore(whole.state());
  for (Simulation* one : {&whole, &resumed})
    while (one->steps() < 450) one->step(m.time.end);
  EXPECT_GT(*whole.facts().flow_rows, 2.0);
  EXPECT_LT(*whole.facts().flow_rows, 8.0);
  EXPECT_EQ(*whole.facts().flow_rows, *resumed.facts().flow_rows);
}

}  // namespace
}  // namespace talus

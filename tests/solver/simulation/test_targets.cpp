// What is measured at targets, against flows and loads that are known.

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "models.hpp"
#include "simulation/flow_at.hpp"
#include "simulation/observables.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// Four rows of soil at rest density from x = 0 to 20, of which row r moves at (1 + r, 0) m/s and soil beyond x = 10
/// twice as fast.
Soil sheared_layer(double dx) {
  Soil soil;
  for (double x = 0.5 * dx; x < 20.0; x += dx)
    for (int row = 0; row < 4; ++row) {
      soil.x.push_back(x);
      soil.y.push_back((row + 0.5) * dx);
      soil.vx.push_back((1.0 + row) * (x > 10.0 ? 2.0 : 1.0));
      soil.vy.push_back(0.0);
      soil.m.push_back(2000.0 * dx * dx);
      soil.material.push_back(0);
    }
  soil.n_active = soil.x.size();
  return soil;
}
const std::vector<Material> materials{{"soil", 2000, 0.5, 0, 0}};

Target target(double from, double to, double threshold = 0.5) {
  return {.of = {"here", from == to ? TargetKind::point : TargetKind::stretch},
          .from = from,
          .to = to,
          .threshold = threshold};
}

TEST(FlowAt, IsThatOfALayer) {
  const double dx = 0.25;
  const Soil soil = sheared_layer(dx);
  for (const double x : {5.0, 5.1}) {
    const TargetFlow flow = flow_at(target(x, x), soil, materials, dx);
    EXPECT_NEAR(flow.depth, 4 * dx, 3e-3 * dx);
    EXPECT_NEAR(flow.speed, (1.0 + 2.0 + 3.0 + 4.0) / 4.0, 1e-12);
    EXPECT_NEAR(flow.dynamic_pressure, 2000.0 * (1.0 + 4.0 + 9.0 + 16.0) / 4.0, 1e-9);
  }
}

TEST(FlowAt, OfAStretchIsTheLargestAlongIt) {
  const double dx = 0.25;
  const Soil soil = sheared_layer(dx);
  EXPECT_NEAR(flow_at(target(3.0, 17.0), soil, materials, dx).speed, 2.0 * 2.5, 1e-9);
  EXPECT_NEAR(flow_at(target(3.0, 8.0), soil, materials, dx).speed, 2.5, 1e-9);
  EXPECT_NEAR(flow_at(target(-50.0, 30.0), soil, materials, dx).depth, 4 * dx, 1e-2 * dx);
}

TEST(FlowAt, IsNothingBelowTheThresholdAndBeyondTheSoil) {
  const double dx = 0.25;
  Soil soil = sheared_layer(dx);
  const TargetFlow thin = flow_at(target(5.0, 5.0, 1.1), soil, materials, dx);
  EXPECT_NEAR(thin.depth, 1.0, 1e-3);
  EXPECT_EQ(thin.speed, 0.0);
  EXPECT_EQ(thin.dynamic_pressure, 0.0);
  EXPECT_EQ(flow_at(target(20.8, 20.8), soil, materials, dx).depth, 0.0);
  soil.n_active = 0;
  EXPECT_EQ(flow_at(target(5.0, 5.0), soil, materials, dx).depth, 0.0) << "soil that left counts";
}

/// A structure as boundary 1 whose loads count to the left.
TargetGauges gauges_of_a_structure(double averaging) {
  Target wall = target(5.0, 5.0);
  wall.of.kind = TargetKind::structure;
  wall.structure = Structure{1, {0, 0}, averaging};
  return {{target(2.0, 2.0), wall}, SlidesTo::left, 0.25};
}

TEST(TargetGauges, PeaksAreMeansOverTheAveragingTime) {
  TargetGauges gauges = gauges_of_a_structure(0.5);
  const Soil none = [] {
    Soil soil = sheared_layer(0.25);
    soil.n_active = 0;
    return soil;
  }();
  const std::vector<WallLoad> weak{{{-10, 4}, 6}}, strong{{{-30, -8}, -2}};
  gauges.add_loads(weak, 0.25, 0.25);
  gauges.add_loads(strong, 0.25, 0.5);   // means -20, -2, 2
  gauges.add_loads(strong, 0.5, 1.0);    // means -30, -8, -2
  gauges.add_loads(strong, 0.25, 1.25);  // not a whole averaging time
  const TargetOutcome wall = gauges.outcomes(none, materials, {0, SlidesTo::left}, true, 1.0, 0.0)[1];
  EXPECT_DOUBLE_EQ(wall.peak_horizontal_force, 30.0) << "in the direction of the slide";
  EXPECT_DOUBLE_EQ(wall.peak_downward_force, 8.0);
  EXPECT_DOUBLE_EQ(wall.peak_overturning_moment, 2.0) << "counter-clockwise overturns to the left";
  EXPECT_DOUBLE_EQ(wall.final_horizontal_force, 30.0);
  EXPECT_DOUBLE_EQ(wall.horizontal_impulse, 0.25 * 10 + 1.0 * 30);
  EXPECT_DOUBLE_EQ(wall.downward_impulse, -0.25 * 4 + 1.0 * 8);
  const std::vector<TargetRow> rows = gauges.rows(none, materials, 1.25, 7);
  EXPECT_DOUBLE_EQ(rows[1].impulse.force.x, 32.5);
  EXPECT_EQ(rows[0].impulse, WallLoad{});
}

TEST(TargetGauges, AnArrivalIsTheFirstObservationAboveTheThreshold) {
  TargetGauges gauges({target(5.0, 5.0), target(25.0, 25.0)}, SlidesTo::right, 0.25);
  Soil soil = sheared_layer(0.25);
  soil.n_active = 0;
  gauges.observe(soil, materials, 1.0);
  soil.n_active = soil.x.size();
  gauges.observe(soil, materials, 2.0);
  gauges.observe(soil, materials, 3.0);
  const auto outcomes = gauges.outcomes(soil, materials, {}, false, 1.0, 24.0);
  EXPECT_TRUE(outcomes[0].arrives);
  EXPECT_EQ(outcomes[0].arrival, 2.0);
  EXPECT_TRUE(outcomes[0].open) << "the flow there is faster than the speed of rest";
  EXPECT_FALSE(gauges.outcomes(soil, materials, {}, false, 3.0, 24.0)[0].open);
  EXPECT_FALSE(outcomes[1].arrives);
  EXPECT_TRUE(std::isnan(outcomes[1].arrival));
  EXPECT_FALSE(outcomes[1].open) << "the soil cannot reach it any more";
  EXPECT_TRUE(gauges.outcomes(soil, materials, {}, false, 1.0, 25.5)[1].open);
  EXPECT_FALSE(gauges.outcomes(soil, materials, {}, true, 1.0, 25.5)[1].open);
}

/// A column that collapses against a block from x = 2 to 2.6.
Model with_block(double dx = 0.05) {
  Model m = collapse(dx);
  m.boundaries.push_back({.name = "block", .line = {{{2.0, -0.2}, {2.0, 0.5}, {2.6, 0.5}, {2.6, -0.2}}, true}});
  Target block{.of = {"block", TargetKind::structure}, .threshold = 0.08};
  block.from = block.to = 2.0 - target_reach(dx);
  block.structure = Structure{1, {2.6, 0.0}, 0.05};
  m.targets = {target(1.5, 1.5, 0.08), block};
  m.time.end = 0.8;
  return m;
}

TEST(Targets, ObservationChangesNoBit) {
  Model m = collapse(0.05);
  m.time.end = 0.3;
  Simulation without(m, plan_particles(m));
  m.targets = {target(1.5, 1.5, 0.08), target(2.0, 3.0, 0.08)};
  Simulation with(m, plan_particles(m));
  while (!with.finished()) {
    with.step(m.time.end);
    without.step(m.time.end);
    with.target_rows();
  }
  EXPECT_EQ(digest(with.soil()), digest(without.soil()));
}

TEST(Targets, ARestoredRunHasTheSameOutcomes) {
  const Model m = with_block();
  Simulation whole(m, plan_particles(m));
  while (!whole.finished()) whole.step(m.time.end);
  Simulation first(m, plan_particles(m));
  while (first.time() < 0.45) first.step(m.time.end);
  Simulation second(m, plan_particles(m));
  second.restore(first.state());
  while (!second.finished()) second.step(m.time.end);
  const std::vector<TargetOutcome> a = whole.result().targets, b = second.result().targets;
  EXPECT_EQ(second.result().digest, whole.result().digest);
  ASSERT_TRUE(a[0].arrives && a[1].arrives);
  EXPECT_LT(a[0].arrival, a[1].arrival);
  for (const std::size_t k : {0, 1})
    for (const TargetNumber& number : target_numbers) {
      if (!has_number(a[k].of.kind, number)) continue;
      EXPECT_EQ(a[k].*number.member, b[k].*number.member) << number.key;
    }
}

TEST(Targets, ABlockStopsTheSoil) {
  const Model m = with_block();
  Simulation simulation(m, plan_particles(m));
  while (!simulation.finished()) simulation.step(m.time.end);
  const RunResult result = simulation.result();
  EXPECT_LT(result.measures.front_mass_99, 2.0);
  EXPECT_EQ(result.penetrated, 0);
  EXPECT_GT(result.targets[1].peak_horizontal_force, 100.0);
  EXPECT_GT(result.targets[1].peak_overturning_moment, 0.0);
}

TEST(Targets, NoParticleOfAStructureStandsInTheGround) {
  const Model m = with_block();
  std::size_t of_block = 0;
  for (const WallPoint& point : plan_particles(m).walls) {
    if (point.boundary != 1) continue;
    ++of_block;
    EXPECT_GT(point.x.y, 0.2 * m.dx);
    EXPECT_TRUE(point.x.x > 2.0 && point.x.x < 2.6 && point.x.y < 0.5);
  }
  EXPECT_GT(of_block, 50u);
}

// Closed forms. The soil is water where it has no strength, and the wall of the basin a structure of its own: a block
// on the right of a basin 2 m wide.

/// Water 1 m deep between an end wall at x = 0 and a block at x = 2.
Model basin(double dx, double phi_deg = 0.0) {
  Model m = column(2.0, 1.0, dx, phi_deg);
  set_ground(m, {{{0, 0}, {4, 0}}, false, true, true, 1.5, 0.0});
  m.boundaries.push_back({.name = "wall", .line = {{{2.0, -0.4}, {2.0, 1.4}, {3.0, 1.4}, {3.0, -0.4}}, true}});
  m.boundaries[0].slip = m.boundaries[1].slip = phi_deg > 0.0 ? WallSlip::no_slip : WallSlip::free_slip;
  Target wall{.of = {"wall", TargetKind::structure}, .threshold = 0.5};
  wall.from = wall.to = 2.0 - target_reach(dx);
  wall.structure = Structure{1, {2.0, 0.0}, 0.1};
  m.targets = {wall};
  m.materials[0].rho0 = 1000.0;
  m.time.end = 2.0;
  return m;
}

/// Mean load on the wall over the second half of a run.
WallLoad mean_load(const Model& m) {
  Simulation simulation(m, plan_particles(m));
  while (simulation.time() < 0.5 * m.time.end) simulation.step(0.5 * m.time.end);
  WallLoad gained = simulation.target_rows()[0].impulse;
  gained = -1.0 * gained;
  while (!simulation.finished()) simulation.step(m.time.end);
  gained += simulation.target_rows()[0].impulse;
  return (1.0 / (0.5 * m.time.end)) * gained;
}

TEST(Loads, OfWaterAtRestAreHydrostatic) {  // rho g H^2/2 at H/3
  const double force = 1000 * 9.81 * 0.5, moment = force / 3.0;
  for (const auto& [dx, error] : {std::pair{0.1, 0.06}, std::pair{0.05, 0.03}}) {
    const WallLoad load = mean_load(basin(dx));
    RecordProperty(dx > 0.07 ? "coarse" : "fine",
                   std::to_string(load.force.x / force - 1.0) + " " + std::to_string(load.moment / moment - 1.0));
    EXPECT_NEAR(load.force.x / force, 1.0, error) << dx;
    EXPECT_NEAR(load.moment / moment, 1.0, 2.0 * error) << dx;
    EXPECT_NEAR(load.force.y / force, 0.0, 0.02) << dx;
  }
}

TEST(Loads, OfSoilAtRestLieBetweenActiveAndPassivePressure) {
  const double weight = 1000 * 9.81 * 0.5, phi = 30 * degree;
  const double active = (1 - std::sin(phi)) / (1 + std::sin(phi)), at_rest = 1 - std::sin(phi);
  const WallLoad load = mean_load(basin(0.05, 30.0));
  RecordProperty("K", std::to_string(load.force.x / weight));
  EXPECT_GT(load.force.x / weight, active);
  EXPECT_LT(load.force.x / weight, 1.1) << "hydrostatic at most; K0 = 1 - sin(phi) = " << at_rest;
}

/// A sheet of water 0.6 m thick that falls at 10 m/s, without gravity to speak of, on a block as a plate.
TEST(Loads, OfASheetOnAPlateAreItsMomentumFlux) {  // rho v^2 d, for as long as the sheet lasts
  const double dx = 0.05, speed = 10.0, thickness = 0.6, length = 2.0;
  Model m;
  set_ground(m, {{{-10, -2}, {10, -2}}, false, false, false, 0.0, 0.0});
  m.boundaries[0].slip = WallSlip::free_slip;
  m.boundaries.push_back(
      {.name = "plate", .line = {{{-3, -1.0}, {-3, 0.0}, {3, 0.0}, {3, -1.0}}, true}, .slip = WallSlip::free_slip});
  m.slide = {{{{-0.5 * thickness, 0.2},
               {0.5 * thickness, 0.2},
               {0.5 * thickness, 0.2 + length},
               {-0.5 * thickness, 0.2 + length}},
              0}};
  m.materials = {{"water", 1000, 0, 0, 0}};
  m.dx = dx;
  m.g = {0.0, -1e-3};
  m.numerics.c_s = 100.0;
  m.numerics.initial_pressure = InitialPressure::stress_free;
  Target plate{.of = {"plate", TargetKind::structure}, .threshold = 0.5};
  plate.structure = Structure{1, {0.0, 0.0}, 0.02};
  m.targets = {plate};
  m.time.end = 0.15;
  const ParticlePlan plan = plan_particles(m);
  Simulation simulation(m, plan);
  CheckpointState state = simulation.state();
  for (double& vy : state.reals.at("vy")) vy = -speed;
  simulation.restore(state);
  // The first drop arrives after 0.02 s; the flow round the point of impact is steady after a few d/v.
  while (simulation.time() < 0.09) simulation.step(0.09);
  const double before = simulation.target_rows()[0].impulse.force.y;
  while (simulation.time() < 0.15) simulation.step(0.15);
  const double force = (simulation.target_rows()[0].impulse.force.y - before) / 0.06;
  RecordProperty("ratio", std::to_string(force / (1000 * speed * speed * thickness)));
  EXPECT_NEAR(force / (1000 * speed * speed * thickness), 1.0, 0.1);
}

}  // namespace
}  // namespace talus

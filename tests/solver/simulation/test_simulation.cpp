#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "models.hpp"
#include "simulation/observables.hpp"
#include "simulation/simulation.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

using namespace testing_support;

void run(Simulation& simulation, double end) {
  while (!simulation.finished()) simulation.step(end);
}

TEST(Simulation, CollapseSpreadsStopsAndKeepsItsMass) {
  Model m = collapse(0.05);
  m.time.end = 2.0;
  Simulation simulation(m, plan_particles(m));
  run(simulation, m.time.end);
  const RunResult r = simulation.result();
  EXPECT_GT(r.measures.influence_zone, 1.6);
  EXPECT_LT(r.measures.influence_zone, 3.5);
  EXPECT_TRUE(r.at_rest);
  EXPECT_EQ(r.penetrated, 0);
  EXPECT_EQ(r.left_domain, 0);
  EXPECT_EQ(r.evaluations, 2 * r.steps);
  double mass = 0;
  for (const double x : simulation.soil().m) mass += x;
  EXPECT_NEAR(mass, 2000 * 1.0 * 0.8, 1e-9);
}

TEST(Simulation, BothPrecisionsGoTheSameWay) {
  // Until rounding has grown: past the first re-sort, and past the first departure through the open end.
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    Model m = collapse(0.05);
    set_ground(m, {{{0, 0}, {1.1, 0}}, false, true, false, 1.2, 0});
    m.numerics.integrator = integrator;
    std::vector<Frame> frames;
    for (const auto precision : {Precision::single, Precision::full}) {
      m.numerics.precision = precision;
      Simulation simulation(m, plan_particles(m));
      while (simulation.time() < 0.25) simulation.step(0.25);
      EXPECT_GT(simulation.result().left_domain, 0);
      EXPECT_LT(simulation.result().left_domain, 100);
      frames.push_back(simulation.frame());
    }
    for (std::size_t i = 0; i < frames[0].n_soil; ++i) {
      ASSERT_NEAR(frames[0].position[i].x, frames[1].position[i].x, 1e-5) << i;
      ASSERT_NEAR(frames[0].position[i].y, frames[1].position[i].y, 1e-5) << i;
      ASSERT_NEAR(frames[0].displacement[i].x, frames[1].displacement[i].x, 1e-5) << i;
      ASSERT_NEAR(frames[0].velocity[i].x, frames[1].velocity[i].x, 1e-3) << i;
      ASSERT_NEAR(frames[0].pressure[i], frames[1].pressure[i], 20.0) << i;  // of 16 kPa
      ASSERT_NEAR(frames[0].stress[i][3], frames[1].stress[i][3], 20.0) << i;
      ASSERT_NEAR(frames[0].shear_rate[i], frames[1].shear_rate[i], 0.1) << i;
    }
  }
}

TEST(Simulation, TheMassFormHasTheSameFrontInBothPrecisions) {
  Model m = collapse(0.1);
  m.numerics.continuity = Continuity::mass;
  const auto front = [&](Precision precision, double perturbation) {
    m.numerics.precision = precision;
    const ParticlePlan plan = plan_particles(m);
    SoilProperties properties = material_properties(m, plan);
    for (double& tan_phi : properties.tan_phi) tan_phi *= 1.0 + perturbation;
    Simulation simulation(m, plan, properties);
    run(simulation, m.time.end);
    return simulation.result().measures.influence_zone;
  };
  const double vectorised = front(Precision::single, 0.0);
  // What a relative change of tan(phi) by 1e-6 does to the front is the noise floor.
  const double noise = std::abs(front(Precision::single, 1e-6) - vectorised);
  EXPECT_GT(noise, 0.0);
  EXPECT_LT(noise, 1e-4);
  EXPECT_NEAR(front(Precision::full, 0.0), vectorised, noise);
}

TEST(Simulation, PaperNormStopsShorter) {  // its soil is sqrt(3) times stronger
  Model m = collapse(0.05);
  m.time.end = 1.5;
  m.rheology.yield = Yield::regularized;
  Simulation consistent(m, plan_particles(m));
  run(consistent, m.time.end);
  m.rheology.shear_rate = ShearRate::paper;
  Simulation paper(m, plan_particles(m));
  run(paper, m.time.end);
  EXPECT_LT(farthest(paper.soil()), farthest(consistent.soil()) - 0.1);
}

TEST(Simulation, WeakerParticlesRunFarther) {
  Model m = collapse(0.05);
  const ParticlePlan plan = plan_particles(m);
  const std::vector<double> cohesion(plan.soil.size(), 0.0);
  Simulation strong(m, plan, {std::vector<double>(plan.soil.size(), 0.7), cohesion}),
      weak(m, plan, {std::vector<double>(plan.soil.size(), 0.2), cohesion});
  run(strong, m.time.end);
  run(weak, m.time.end);
  EXPECT_GT(farthest(weak.soil()), farthest(strong.soil()) + 0.2);
}

TEST(Simulation, SnapshotTimesNeverShortenAStepAndTheEndIsMetExactly) {
  Model m = collapse(0.1);
  m.time.fixed_step = 3e-4;
  m.time.end = 0.03;
  Simulation simulation(m, plan_particles(m));
  run(simulation, m.time.end);
  EXPECT_EQ(simulation.steps(), 100);
  EXPECT_EQ(simulation.time(), 0.03);
}

TEST(Simulation, MaxStepBoundsTheCourantStep) {
  Model m = collapse(0.1);
  EXPECT_GT(first_step(m), 1e-4);
  m.time.max_step = 1e-4;
  EXPECT_EQ(first_step(m), 1e-4);
  Simulation simulation(m, plan_particles(m));
  simulation.step(m.time.end);
  EXPECT_EQ(simulation.time(), 1e-4);
}

TEST(Simulation, DivergenceNamesStepTimeAndParticle) {
  Model m = collapse(0.1);
  m.time.fixed_step = 0.05;
  m.time.end = 100.0;  // a hundred times too large
  Simulation simulation(m, plan_particles(m));
  try {
    run(simulation, m.time.end);
    FAIL() << "it should have diverged";
  } catch (const DivergedError& e) {
    EXPECT_EQ(e.step, simulation.steps());
    EXPECT_GT(e.time, 0.0);
    EXPECT_GE(e.particle, 0);
    EXPECT_NE(std::string(e.what()).find("particle " + std::to_string(e.particle)), std::string::npos);
  }
}

TEST(Simulation, SoilThatLeavesThroughAnOpenEndIsCountedAndKept) {
  Model m = collapse(0.05);
  set_ground(m, {{{0, 0}, {1.2, 0}}, false, true, false, 1.2, 0});
  m.materials[0].phi = 5 * degree;
  m.time.end = 1.0;
  Simulation simulation(m, plan_particles(m));
  run(simulation, m.time.end);
  const RunResult r = simulation.result();
  EXPECT_GT(r.left_domain, 10);
  EXPECT_EQ(r.soil, static_cast<std::int64_t>(simulation.soil().size()));
  EXPECT_GE(r.measures.influence_zone, 1.2);
  EXPECT_LT(r.measures.influence_zone, 1.3);
  EXPECT_GT(r.left_domain, r.soil / 100) << "more than 1 % of the mass";
  EXPECT_EQ(r.lower_bounds,
            (std::vector<std::string>{"influence_zone_m", "front_connected_m", "front_mass_99_m", "front_mass_999_m",
                                      "centre_of_mass_x_m", "front_at_thickness_m"}));
}

TEST(Simulation, ABlockOnASmootherWallSlidesAtTheWallsFriction) {
  // theta = 30 deg; soil 45 deg would hold, a wall of 15 deg lets the block slide at g (sin - cos tan 15).
  const auto speed_after = [](WallSlip slip, double phi_wall_deg) {
    Model m;
    set_ground(m, {{{-1, 0}, {12, 0}}, false, false, false, 0, 0});
    m.slide = {{{{0, 0}, {3, 0}, {3, 0.5}, {0, 0.5}}, 0}};
    m.materials = {{"soil", 2000, 45 * degree, 3000, 0}};
    m.g = {9.81 * std::sin(30 * degree), -9.81 * std::cos(30 * degree)};
    m.dx = 0.1;
    m.boundaries.front().slip = slip;
    m.boundaries.front().phi = phi_wall_deg * degree;
    m.time.end = 0.8;
    m.numerics.initial_pressure = InitialPressure::hydrostatic;
    m.boundaries.front().c = 0.0;
    Simulation simulation(m, plan_particles(m));
    run(simulation, m.time.end);
    double momentum = 0.0;  // along the slope
    for (std::size_t i = 0; i < simulation.soil().size(); ++i)
      momentum += simulation.soil().m[i] * simulation.soil().vx[i];
    return momentum / (2000 * 3 * 0.5);
  };
  const double free_fall = 9.81 * std::sin(30 * degree) * 0.8;
  EXPECT_NEAR(speed_after(WallSlip::free_slip, 0), free_fall, 0.01 * free_fall);
  const double expected = 9.81 * (std::sin(30 * degree) - std::cos(30 * degree) * std::tan(15 * degree)) * 0.8;
  EXPECT_NEAR(speed_after(WallSlip::friction, 15), expected, 0.1 * expected);
  EXPECT_LT(speed_after(WallSlip::no_slip, 0), 0.05);
}

TEST(Simulation, ASlabIsHeldByTheWallsCohesionUpToItsWeightAlongTheSlope) {
  // theta = 30 deg, H = 0.5 m: the wall must carry rho g H sin(theta) = 4.9 kPa; with c less the slab accelerates at
  // g sin(theta) - c/(rho H). Its ends, beyond which the kernel reaches by a spacing, are 2 % of its length.
  const double weight = 2000 * 9.81 * 0.5 * std::sin(30 * degree), time = 0.8;
  const auto speed_after = [&](std::optional<double> cohesion, Precision precision) {
    Model m;
    set_ground(m, {{{-1, 0}, {18, 0}}, false, false, false, 0, 0});
    m.slide = {{{{0, 0}, {9, 0}, {9, 0.5}, {0, 0.5}}, 0}};
    m.materials = {{"clay", 2000, 20 * degree, 4 * weight, 0}};
    m.g = {9.81 * std::sin(30 * degree), -9.81 * std::cos(30 * degree)};
    m.dx = 0.1;
    m.numerics.precision = precision;
    m.numerics.velocity_jump = VelocityJump::reconstructed;  // the whole jump across the wall would drag by 1 kPa
    m.boundaries.front().slip = WallSlip::friction;
    m.boundaries.front().c = cohesion;
    m.time.end = time;
    Simulation simulation(m, plan_particles(m));
    run(simulation, m.time.end);
    double momentum = 0.0;  // along the slope
    for (std::size_t i = 0; i < simulation.soil().size(); ++i)
      momentum += simulation.soil().m[i] * simulation.soil().vx[i];
    return momentum / (2000 * 9 * 0.5);
  };
  const double free_fall = 9.81 * std::sin(30 * degree) * time;
  for (const auto precision : {Precision::single, Precision::full}) {
    EXPECT_NEAR(speed_after(0.0, precision), free_fall, 0.03 * free_fall);
    EXPECT_NEAR(speed_after(0.5 * weight, precision), 0.5 * free_fall, 0.03 * free_fall);
    EXPECT_LT(speed_after(1.1 * weight, precision), 0.02 * free_fall);
    EXPECT_LT(speed_after({}, precision), 0.02 * free_fall) << "the soil's own cohesion acts on the wall";
  }
}

TEST(Simulation, BlocksOnTwoBoundariesSlideEachAtTheFrictionOfItsOwn) {
  Model m;
  m.terrain.bed = {{-1, 0}, {12, 0}};
  m.boundaries = {
      {.name = "rock", .line = {{{-1, 0}, {5, 0}}}, .slip = WallSlip::friction, .phi = 15 * degree, .c = 0.0},
      {.name = "ice", .line = {{{5, 0}, {12, 0}}}, .slip = WallSlip::free_slip}};
  m.slide = {{{{0, 0}, {3, 0}, {3, 0.5}, {0, 0.5}}, 0}, {{{6, 0}, {8, 0}, {8, 0.5}, {6, 0.5}}, 1}};
  m.materials = {{"sand", 2000, 45 * degree, 3000, 0}, {"clay", 2000, 45 * degree, 3000, 0}};
  m.g = {9.81 * std::sin(30 * degree), -9.81 * std::cos(30 * degree)};
  m.time.end = 0.6;
  for (const auto precision : {Precision::single, Precision::full}) {
    m.numerics.precision = precision;
    Simulation simulation(m, plan_particles(m));
    run(simulation, m.time.end);
    const Soil& soil = simulation.soil();
    double momentum[2] = {0, 0}, mass[2] = {0, 0};
    for (std::size_t i = 0; i < soil.size(); ++i) {
      momentum[soil.material[i]] += soil.m[i] * soil.vx[i];
      mass[soil.material[i]] += soil.m[i];
    }
    const double free_fall = 9.81 * std::sin(30 * degree) * m.time.end;
    const double braked = free_fall - 9.81 * std::cos(30 * degree) * std::tan(15 * degree) * m.time.end;
    EXPECT_NEAR(momentum[0] / mass[0], braked, 0.1 * braked);
    EXPECT_NEAR(momentum[1] / mass[1], free_fall, 0.01 * free_fall);
  }
}

TEST(Simulation, WholeRightHandSideIsOfSecondOrderInTime) {
  // Smooth as far as SPH goes: no walls near, no switches (tension kept, no artificial viscosity), strong elastic soil.
  const auto position_after = [](double dt) {
    Model m = collapse(0.1);
    set_ground(m, {{{-10, -10}, {10, -10}}, false, false, false, 0, 0});
    m.g = {0, 0};
    m.materials = {{"soil", 2000, 0, 1e9, 0}};
    m.numerics.alpha = 0;
    m.numerics.tension_cutoff = false;
    m.numerics.c_s = 20;
    m.time.fixed_step = dt;
    m.time.end = 0.01;
    Simulation simulation(m, plan_particles(m));
    const Soil& s = simulation.soil();
    CheckpointState state = simulation.state();
    for (std::size_t i = 0; i < s.size(); ++i) {
      state.reals["vx"][i] = 0.3 * std::sin(2 * s.y[i]);
      state.reals["vy"][i] = 0.2 * std::cos(3 * s.x[i]);
      state.reals["rho"][i] = 2000;
    }
    simulation.restore(state);
    run(simulation, m.time.end);
    std::vector<double> x(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) x[static_cast<std::size_t>(s.id[i])] = s.vx[i];
    return x;
  };
  const auto difference = [](const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
  };
  const auto coarse = position_after(4e-4), middle = position_after(2e-4), fine = position_after(1e-4);
  EXPECT_NEAR(std::log2(difference(coarse, middle) / difference(middle, fine)), 2.0, 0.2);
}

/// A slide on a slope of 30 degrees that runs out on level ground, and its mirror image.
Model sloping(SlidesTo to) {
  const double sign = to == SlidesTo::right ? 1.0 : -1.0;
  const auto line = [&](std::vector<Vec2> points) {
    for (Vec2& p : points) p.x *= sign;
    return points;
  };
  Model m;
  Terrain terrain{.bed = line({{0, 8.2}, {14.202, 0}, {40, 0}}), .wall_top = 14.0, .run_out = {0.0, to}};
  if (to == SlidesTo::left) {
    std::ranges::reverse(terrain.bed);
    std::swap(terrain.left_wall, terrain.right_wall);
  }
  set_ground(m, terrain);
  m.slide = {{line({{0, 8.2}, {14.202, 0}, {21.325, 0}, {9.125, 12.2}, {0, 12.2}}), 0}};
  m.materials = {{"soil", 2200, 25 * degree, 0, 0}};
  m.dx = 0.4;
  m.time.end = 2.0;
  return m;
}

TEST(Simulation, AMirroredSlideHasTheMirroredRunOut) {
  const auto run = [](SlidesTo to) {
    const Model m = sloping(to);
    Simulation simulation(m, plan_particles(m));
    while (!simulation.finished()) simulation.step(m.time.end);
    return simulation.result();
  };
  const RunResult right = run(SlidesTo::right), left = run(SlidesTo::left);
  EXPECT_EQ(right.soil, left.soil);
  EXPECT_EQ(right.steps, left.steps);
  EXPECT_GT(right.measures.influence_zone, 23.0);
  // The particles are stored in another order, which rounds the single-precision sums otherwise.
  for (const Measure& m : measure_table) EXPECT_NEAR(right.measures.*m.member, left.measures.*m.member, 2e-5) << m.key;
}

TEST(Simulation, TheMassIsThatOfTheOutlines) {
  const Model m = sloping(SlidesTo::right);
  const ParticlePlan plan = plan_particles(m);
  const RunResult r = Simulation(m, plan).result();
  EXPECT_NEAR(r.mass.outline, 2200 * area(m.slide[0].outline), 1e-9 * r.mass.outline);
  EXPECT_NEAR(r.mass.filled, r.mass.outline, 1e-5 * r.mass.outline);
  EXPECT_NEAR(slide_mass(m, plan).filled, r.mass.filled, 1e-9 * r.mass.filled);
  Model whole = m;
  whole.placement = Placement::whole_cells;
  EXPECT_LT(Simulation(whole, plan_particles(whole)).result().mass.filled, 0.97 * r.mass.outline);
}

TEST(Simulation, TheLatticeOfTheModelIsFilled) {
  const Model m = sloping(SlidesTo::right);
  Model turned = m;
  turned.lattice = {{0.25, 0.5}, 0.5};
  const ParticlePlan plan = plan_particles(m), other = plan_particles(turned);
  EXPECT_NEAR(slide_mass(turned, other).filled, slide_mass(m, plan).filled, 1e-5 * slide_mass(m, plan).filled);
  EXPECT_GT(norm(other.soil.back().x - plan.soil.back().x), 0.1 * m.dx);
}

TEST(Simulation, NoParticleAndTooManyAreRefused) {
  Model m = collapse(0.1);
  m.max_particles = 50;
  try {
    plan_particles(m);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("max_particles"), std::string::npos);
  }
  m = collapse(5.0);
  m.placement = Placement::whole_cells;
  EXPECT_THROW(plan_particles(m), ConfigError);
}

TEST(Simulation, FrameIsInOrderOfIdWithTheStressOfPlaneStrain) {
  Model m = collapse(0.1);
  Simulation simulation(m, plan_particles(m));
  const Frame start = simulation.frame();
  for (int k = 0; k < 60; ++k) simulation.step(m.time.end);
  const Frame f = simulation.frame();
  ASSERT_EQ(f.n_soil, 80u);
  ASSERT_EQ(f.position.size(), 80u + simulation.walls().size());
  for (std::size_t i = 0; i < f.position.size(); ++i) {
    const Vec2 d = f.position[i] - start.position[i];
    EXPECT_NEAR(d.x, f.displacement[i].x, 1e-8);
    EXPECT_NEAR(d.y, f.displacement[i].y, 1e-8);
    EXPECT_NEAR(f.stress[i][0] + f.stress[i][1] + f.stress[i][2], -3 * f.pressure[i], 1e-6);
    if (i >= f.n_soil) {
      EXPECT_EQ(norm(f.velocity[i]), 0.0);
    }
  }
}

}  // namespace
}  // namespace talus

// The energy balance of runs: closed forms, what it explains, what it finds.

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "simulation/energy_account.hpp"
#include "slopes.hpp"

namespace talus {
namespace {

using namespace testing_support;

EnergyBudget after(const Model& m, double time) {
  Simulation simulation(m, plan_particles(m));
  while (simulation.time() < time) simulation.step(time);
  return simulation.energy();
}

TEST(Energy, MeasurementsKeepNoPaceWithAnythingElse) {
  const Model large = slope(0.45), small = slope(0.6);
  const auto account_of = [](const Model& m) {
    const FlowConstants k = flow_constants(m);
    const ParticlePlan plan = plan_particles(m);
    return EnergyAccount(k, make_soil(m, k, plan, material_properties(m, plan)));
  };
  ASSERT_GT(plan_particles(large).soil.size(), 500u);
  ASSERT_LT(plan_particles(small).soil.size(), 500u);
  const EnergyAccount account = account_of(large), often = account_of(small);
  constexpr std::int64_t steps = 30000;
  for (const std::int64_t period : {2, 5, 7, 30}) {
    std::vector<int> hits(static_cast<std::size_t>(period), 0);
    for (std::int64_t step = 0; step < steps; ++step)
      hits[static_cast<std::size_t>(step % period)] += account.due(step);
    const double mean = static_cast<double>(steps) / (4 + std::numbers::phi) / static_cast<double>(period);
    for (const int n : hits) EXPECT_NEAR(n, mean, 0.02 * mean + 3) << period;
  }
  EXPECT_TRUE(account.due(0));
  for (std::int64_t step = 0; step < 100; ++step) EXPECT_TRUE(often.due(step));
}

TEST(Energy, WorkIsTheTrapezoidalSumOfPowersMeasuredAtAnyTimes) {
  const Model m = slope(0.6);
  const FlowConstants k = flow_constants(m);
  const ParticlePlan plan = plan_particles(m);
  const Soil soil = make_soil(m, k, plan, material_properties(m, plan));
  const StartingPositions starts(plan.soil, bounding_box(m.slide));
  EnergyAccount account(k, soil);
  account.measure({.deviator = 2, .viscosity = 3, .artificial_viscosity = 5, .density_diffusion = 7, .boundaries = 11},
                  0.5);
  account.measure({.deviator = 4, .viscosity = 9, .artificial_viscosity = 5, .density_diffusion = 1, .boundaries = 1},
                  2.5);
  account.filtered(100);
  const auto expect_sums = [&](const EnergyAccount& a) {
    const EnergyBudget e = a.budget(k, soil, starts, 3.5, 13);
    EXPECT_DOUBLE_EQ(e.friction, 2 * 0.5 + (2 + 4) / 2.0 * 2 + 4 * 1);
    EXPECT_DOUBLE_EQ(e.viscosity, 3 * 0.5 + (3 + 9) / 2.0 * 2 + 9 * 1);
    EXPECT_DOUBLE_EQ(e.artificial_viscosity, 5 * 3.5);
    EXPECT_DOUBLE_EQ(e.density_diffusion, 7 * 0.5 + (7 + 1) / 2.0 * 2 + 1 * 1 + 100);
    EXPECT_DOUBLE_EQ(e.boundaries, 11 * 0.5 + (11 + 1) / 2.0 * 2 + 1 * 1);
    EXPECT_EQ(e.contact, 13);
  };
  expect_sums(account);
  EnergyAccount restored(k, soil);
  restored.restore(account.state());
  expect_sums(restored);
}

TEST(Energy, OfOneParticleBeforeAndAfterItLeaves) {
  const Model m = slope(0.6);
  const FlowConstants k = flow_constants(m);
  const ParticlePlan plan = plan_particles(m);
  Soil soil = make_soil(m, k, plan, material_properties(m, plan));
  const StartingPositions starts(plan.soil, bounding_box(m.slide));
  const EnergyAccount account(k, soil);
  for (double& rho : soil.rho) rho = 2200;
  const std::size_t last = soil.size() - 1;
  soil.y[last] -= 5;
  soil.vx[last] = 3;
  soil.vy[last] = -4;
  soil.rho[last] = 2200 * 1.01;
  soil.txx[last] = 300;
  soil.tyy[last] = -500;
  soil.txy[last] = 700;
  const double mass = soil.m[last], kinetic = 0.5 * mass * 5 * 5;
  const double compression = mass * k.c_s * k.c_s / 7 * ((std::pow(1.01, 6) - 1) / 6 + 1 / 1.01 - 1);
  const double t2 = 300 * 300 + 500 * 500 + 200 * 200 + 2 * 700 * 700;  // t_zz = 200
  const double distortion = mass / (2200 * 1.01) * t2 / (4 * k.soils[0].G);
  for (const bool left : {false, true}) {
    soil.n_active = left ? last : soil.size();
    const EnergyBudget e = account.budget(k, soil, starts, 0.0, 0.0);
    EXPECT_NEAR(e.potential, -mass * 9.81 * 5, 1e-6 * mass);
    EXPECT_NEAR(e.kinetic, left ? 0 : kinetic, 1e-9 * kinetic);
    EXPECT_NEAR(e.compression, left ? 0 : compression, 1e-9 * compression);
    EXPECT_NEAR(e.distortion, left ? 0 : distortion, 1e-9 * distortion);
    EXPECT_NEAR(e.departed, left ? kinetic + compression + distortion : 0, 1e-9 * kinetic);
    EXPECT_NEAR(e.friction, -distortion, 1e-9 * distortion) << "the work of the deviator less what is stored";
  }
}

TEST(Energy, OfABallisticBlockIsKineticAndPotential) {
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    Model m = column(4.0, 2.0, 0.25);
    for (Vec2& v : m.slide[0].outline) v = v + Vec2{0.5, 20};
    m.slide[0].outline[1].x = m.slide[0].outline[2].x = 2.5;
    m.terrain.wall_top = 30;
    m.numerics.initial_pressure = InitialPressure::stress_free;
    m.numerics.density_filter = DensityFilter::none;  // the diffusion expects the pressure of a layer at rest
    m.numerics.integrator = integrator;
    m.g = {2.0, -9.81};
    const EnergyBudget e = after(m, 0.5);
    const double mass = 2000 * 2.0 * 2.0, fall2 = 0.25 * (2.0 * 2.0 + 9.81 * 9.81);  // (g t)^2
    EXPECT_NEAR(e.kinetic, 0.5 * mass * fall2, 1e-6 * e.kinetic);                    // g in single precision
    EXPECT_NEAR(e.potential, -e.kinetic, 1e-6 * e.kinetic);  // starting positions are kept to 2^-30 of the extent
    for (const EnergyTerm& term : energy_terms) {
      if (term.value == &EnergyBudget::kinetic || term.value == &EnergyBudget::potential) continue;
      EXPECT_NEAR(e.*term.value, 0.0, 1e-9 * e.kinetic) << term.key;
    }
  }
}

TEST(Energy, AtTheStartIsThatOfTheHydrostaticPressure) {
  const Model m = column(2.0, 4.0, 0.05);
  const Simulation simulation(m, plan_particles(m));
  const EnergyBudget e = simulation.energy();
  // p^2/(2 rho0 c^2) for small p, over the depth: (rho g)^2 H^3/(6 rho c^2) for each metre of width.
  const double c = simulation.constants().c_s, rho = 2000, H = 4, g = 9.81;
  EXPECT_NEAR(e.stored_at_start, 2.0 * rho * g * g * H * H * H / (6 * c * c), 0.02 * e.stored_at_start);
  EXPECT_EQ(e.compression, e.stored_at_start);
  EXPECT_NEAR(e.created(), 0.0, 1e-9 * e.stored_at_start);
}

TEST(Energy, OfAnElasticColumnGoesToAndFro) {
  // Too strong to yield and without numerical losses, suddenly loaded by its weight: potential, kinetic, compression
  // and distortion exchange, and nothing is lost. The distortion t:t/4G must be what the deviator's power has stored.
  for (const auto precision : {Precision::single, Precision::full}) {
    Model m = column(1.0, 2.0, 0.1);
    m.boundaries[0].slip = WallSlip::free_slip;
    m.materials[0].c = 1e8;
    m.numerics.initial_pressure = InitialPressure::stress_free;
    m.numerics.alpha = 0.0;
    m.numerics.density_filter = DensityFilter::none;
    m.numerics.tension_cutoff = false;
    m.numerics.precision = precision;
    m.numerics.cfl = 0.1;
    Simulation simulation(m, plan_particles(m));
    double kinetic = 0, compression = 0, distortion = 0, worst = 0, unexplained = 0;
    while (simulation.time() < 0.15) {
      simulation.step(0.15);
      const EnergyBudget e = simulation.energy();
      kinetic = std::max(kinetic, e.kinetic);
      compression = std::max(compression, e.compression);
      distortion = std::max(distortion, e.distortion);
      worst = std::max(worst, std::abs(e.friction));
      unexplained = std::max(unexplained, std::abs(e.created()));
    }
    EXPECT_GT(distortion, 0.03 * kinetic);
    EXPECT_GT(compression, 0.3 * kinetic);
    EXPECT_LT(worst, 0.02 * distortion);
    EXPECT_LT(unexplained, 0.002 * kinetic);
  }
}

TEST(Energy, DepartedSoilTakesItsKineticAndElasticEnergyAlong) {
  Model m = collapse(0.05);
  set_ground(m, {{{0, 0}, {1.1, 0}}, false, true, false, 1.2, 0});
  Simulation simulation(m, plan_particles(m));
  while (simulation.time() < 0.6) simulation.step(0.6);
  const EnergyBudget e = simulation.energy();
  const Soil& soil = simulation.soil();
  ASSERT_LT(soil.n_active + 20, soil.size());
  double kinetic = 0, departed = 0;
  for (std::size_t i = 0; i < soil.size(); ++i)
    (i < soil.n_active ? kinetic : departed) += 0.5 * soil.m[i] * norm2(soil.velocity(i));
  EXPECT_NEAR(e.kinetic, kinetic, 1e-12 * kinetic);
  EXPECT_GE(e.departed, departed);
  EXPECT_LT(e.departed, 1.1 * departed);
  EXPECT_LT(std::abs(*e.created_share()), 0.005);
}

TEST(Energy, SharesOfTermsAndOfCreation) {
  const EnergyBudget e{.kinetic = 1,
                       .potential = -64,
                       .compression = 3,
                       .distortion = 5,
                       .friction = 20,
                       .viscosity = 7,
                       .artificial_viscosity = 9,
                       .density_diffusion = 2,
                       .boundaries = 4,
                       .contact = 6,
                       .departed = 8,
                       .stored_at_start = 2};
  EXPECT_EQ(e.created(), 1 - 64 + 3 + 5 + 20 + 7 + 9 + 2 + 4 + 6 + 8 - 2);
  EXPECT_EQ(e.created_share(), e.created() / 64);
  EXPECT_EQ(e.numerical_share(), 11.0 / 64);
  EXPECT_EQ((EnergyBudget{.potential = 1}).created_share(), std::nullopt);
}

TEST(Energy, HasTheSameBitsForAnyNumberOfThreadsAndAcrossACheckpoint) {
  for (const auto filter : {DensityFilter::delta_sph, DensityFilter::shepard}) {
    Model m = slope(0.3);  // more than one group of particles in the contact, and measurements some steps apart
    m.numerics.density_filter = filter;
    m.numerics.filter_interval = 9;
    const int usual = omp_get_max_threads();
    const auto run = [&](int threads, bool interrupted) {
      omp_set_num_threads(threads);
      Simulation first(m, plan_particles(m)), second(m, plan_particles(m));
      for (int k = 0; k < 61; ++k) first.step(m.time.end);
      second.restore(first.state());
      Simulation& whole = interrupted ? second : first;
      for (int k = 0; k < 50; ++k) whole.step(m.time.end);
      omp_set_num_threads(usual);
      return whole.energy();
    };
    const EnergyBudget one = run(1, false);
    EXPECT_EQ(run(3, false), one);
    EXPECT_EQ(run(1, true), one);
    EXPECT_NE(one.density_diffusion, 0.0);
  }
}

TEST(Energy, OfASlideIsExplained) {
  Model m = slope();
  EXPECT_LT(std::abs(created_share(m)), 1e-4);
}

TEST(Energy, TheShepardFilterCountsWhatItTakes) {
  Model m = slope(0.6);
  m.numerics.density_filter = DensityFilter::shepard;
  m.time.end = 4.0;
  const EnergyBudget e = after(m, m.time.end);
  EXPECT_LT(std::abs(*e.created_share()), 0.004);
  EXPECT_GT(e.density_diffusion, 0.004 * e.gravity_work()) << "counted with the other sign, it would show";
}

TEST(Energy, FindsAnUnstableRun) {
  Model m = slope();
  m.numerics.integrator = Integrator::leapfrog;
  m.numerics.cfl = 0.8;
  EXPECT_GT(created_share(m), 0.3);
}

}  // namespace
}  // namespace talus

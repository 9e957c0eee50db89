// Whole runs: what gravity gave is explained to 1 %, with every option of the method; and what is not stable is found.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "slopes.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// Water of 0.1 m width and 0.2 m height beside an empty basin.
Model dam_break() {
  Model m = column(0.1, 0.2, 0.005);
  set_ground(m, {{{0, 0}, {0.6, 0}}, false, true, true, 0.4, 0.0});
  m.boundaries[0].slip = WallSlip::free_slip;
  m.materials = {{"water", 1000, 0, 0, 0.001}};
  m.time.end = 0.25;
  return m;
}

/// Soil in a ring of eight corners, filled to a third on one side.
Model ring() {
  Model m;
  Terrain terrain;
  for (int k = 0; k < 8; ++k) terrain.bed.push_back({3 * std::cos(k * 45 * degree), 3 * std::sin(k * 45 * degree)});
  terrain.closed = true;
  set_ground(m, terrain);
  m.slide = {{{{-2, -1.2}, {0, -2.2}, {0, 0}, {-2, 0}}, 0}};
  m.materials = {{"soil", 2000, 20 * degree, 0, 0}};
  m.dx = 0.1;
  m.time.end = 3.0;
  return m;
}

/// A model and what is changed of it.
struct Slide {
  const char* name;
  Model model;
  std::function<void(Model&)> change = [](Model&) {};
};

double created_share_of(Slide run) {
  run.change(run.model);
  return created_share(run.model);
}

TEST(EnergyRuns, WhatGravityGaveIsExplainedToOnePercent) {
  const std::vector<Slide> runs = {
      {"leapfrog", slope(), [](Model& m) { m.numerics.integrator = Integrator::leapfrog; }},
      {"leapfrog at its limit", slope(),
       [](Model& m) {
         m.numerics.integrator = Integrator::leapfrog;
         m.numerics.cfl = 0.5;
       }},
      {"midpoint rule at its limit", slope(), [](Model& m) { m.numerics.cfl = 0.8; }},
      {"Shepard filter", slope(), [](Model& m) { m.numerics.density_filter = DensityFilter::shepard; }},
      {"double precision", slope(0.6), [](Model& m) { m.numerics.precision = Precision::full; }},
      {"mass form", slope(), [](Model& m) { m.numerics.continuity = Continuity::mass; }},
      {"viscosity", slope(), [](Model& m) { m.materials[0].eta = 1300; }},
      {"tension", slope(), [](Model& m) { m.numerics.tension_cutoff = false; }},
      {"cubic spline", slope(), [](Model& m) { m.numerics.kernel = KernelShape::cubic_spline; }},
      {"wall friction", slope(),
       [](Model& m) {
         m.boundaries[0].slip = WallSlip::friction;
         m.boundaries[0].phi = 15 * degree;
       }},
      {"free slip, soil leaves", slope(), [](Model& m) { m.boundaries[0].slip = WallSlip::free_slip; }},
      {"regularised law, fine steps", slope(0.6),
       [](Model& m) {
         m.rheology.yield = Yield::regularized;
         m.numerics.cfl = 0.1;
       }},
      {"column", collapse(0.05)},
      {"dam break", dam_break()},
      {"ring", ring()},
      {"cliff", cliff()},
      {"cliff, leapfrog", cliff(), [](Model& m) { m.numerics.integrator = Integrator::leapfrog; }},
      {"cliff, finer", cliff(0.25)},
  };
  for (const Slide& run : runs) EXPECT_LT(std::abs(created_share_of(run)), 0.01) << run.name;
}

TEST(EnergyRuns, RandomStrengthChangesNothing) {
  Model m = slope();
  const ParticlePlan plan = plan_particles(m);
  SoilProperties properties = material_properties(m, plan);
  for (std::size_t i = 0; i < properties.tan_phi.size(); ++i)
    properties.tan_phi[i] *= 1.0 + 0.4 * std::sin(0.7 * static_cast<double>(i));
  Simulation simulation(m, plan, properties);
  while (!simulation.finished()) simulation.step(m.time.end);
  EXPECT_LT(std::abs(*simulation.energy().created_share()), 0.01);
}

TEST(EnergyRuns, RandomDensityAndViscosityChangeNothing) {
  Model m = slope();
  const ParticlePlan plan = plan_particles(m);
  SoilProperties properties = material_properties(m, plan);
  for (std::size_t i = 0; i < plan.soil.size(); ++i) {
    properties.rho0.push_back(2200 * (1.0 + 0.15 * std::sin(0.7 * static_cast<double>(i))));
    properties.eta.push_back(900 + 800 * std::cos(0.3 * static_cast<double>(i)));
  }
  Simulation simulation(m, plan, properties);
  while (!simulation.finished()) simulation.step(m.time.end);
  EXPECT_LT(std::abs(*simulation.energy().created_share()), 0.01);
  EXPECT_GT(simulation.energy().viscosity, 0.03 * simulation.energy().gravity_work());
}

TEST(EnergyRuns, WhatIsNotStableIsFound) {
  const std::vector<Slide> runs = {
      {"leapfrog", slope(),
       [](Model& m) {
         m.numerics.integrator = Integrator::leapfrog;
         m.numerics.cfl = 0.6;
       }},
      {"midpoint rule", slope(), [](Model& m) { m.numerics.cfl = 1.0; }},
      {"walls that act on approaching soil only", slope(),
       [](Model& m) { m.walls.contact = WallContact::approaching; }},
  };
  for (const Slide& run : runs) EXPECT_GT(created_share_of(run), 0.05) << run.name;
}

TEST(EnergyRuns, WithoutAnyDampingTheDepositShakesAndNothingIsCreated) {
  // What the balance does not find: noise that nothing damps keeps the soil moving, and friction takes all.
  const auto at_end = [](double alpha) {
    Model m = slope();
    m.numerics.alpha = alpha;
    m.numerics.density_filter = DensityFilter::none;
    m.numerics.cfl = 0.2;
    Simulation simulation(m, plan_particles(m));
    while (!simulation.finished()) simulation.step(m.time.end);
    return simulation.energy();
  };
  const EnergyBudget damped = at_end(0.1), undamped = at_end(0.0);
  EXPECT_LT(std::abs(*undamped.created_share()), 0.01);
  EXPECT_GT(undamped.friction, 0.95 * undamped.gravity_work());
  EXPECT_GT(undamped.kinetic, 1e-3 * undamped.gravity_work());
  EXPECT_LT(damped.kinetic, 1e-4 * damped.gravity_work());
}

}  // namespace
}  // namespace talus

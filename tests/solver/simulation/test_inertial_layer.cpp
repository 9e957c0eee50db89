// Steady uniform flow with mu(I) on an incline, the profile of Bagnold: mu(I) = tan(theta) at every depth, so that I is
// the same everywhere and u = (2/3) (I/d) sqrt(rho g cos(theta)/rho_s) (h^1.5 - (h - y)^1.5).

#include <gtest/gtest.h>

#include <cmath>

#include "models.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

using namespace testing_support;

constexpr double depth = 0.5, bulk_density = 1500, slope_angle = 27 * degree, static_angle = 20.9 * degree;
/// Grains so large that the flow is slow and finds its profile soon.
constexpr InertialFriction<> grains{.delta_mu = 0.2617, .I_0 = 0.279, .mu_inf = 0.05, .d = 0.4, .rho_s = 2450};

/// I with mu(I) = tan(slope_angle): mu_inf I^2 + (delta_mu - m) I - m I_0 = 0, m = tan(slope_angle) - mu_s.
double steady_inertial_number() {
  const double m = std::tan(slope_angle) - std::tan(static_angle), b = grains.delta_mu - m;
  return (std::sqrt(b * b + 4 * grains.mu_inf * m * grains.I_0) - b) / (2 * grains.mu_inf);
}
double bagnold(double y) {
  const double rate =
      steady_inertial_number() / grains.d * std::sqrt(bulk_density * 9.81 * std::cos(slope_angle) / grains.rho_s);
  return 2.0 / 3 * rate * (std::pow(depth, 1.5) - std::pow(std::max(depth - y, 0.0), 1.5));
}

/// Relative rms error of the velocities in the middle of a long layer after twice the viscous time rho h^2/(2.5 eta),
/// in which waves from its ends do not reach the middle.
/// @param start  of the exact velocity with which the layer starts
double error_of_bagnold(Yield yield, Integrator integrator, double start) {
  Model m;
  set_ground(m, {{{-30, 0}, {30, 0}}, false, false, false, 0, 0});
  m.slide = {{{{-3, 0}, {3, 0}, {3, depth}, {-3, depth}}, 0}};
  m.materials = {{"beads", bulk_density, static_angle, 0, 0, grains}};
  m.g = {9.81 * std::sin(slope_angle), -9.81 * std::cos(slope_angle)};
  m.dx = 0.05;
  m.rheology.yield = yield;
  m.numerics.integrator = integrator;
  m.numerics.alpha = 0.02;
  m.time.end = 0.4;
  Simulation simulation(m, plan_particles(m));
  const Soil& soil = simulation.soil();
  CheckpointState state = simulation.state();
  for (std::size_t i = 0; i < soil.size(); ++i) state.reals["vx"][i] = start * bagnold(soil.y[i]);
  simulation.restore(state);
  const double given = simulation.energy().kinetic;  // not by gravity
  while (!simulation.finished()) simulation.step(m.time.end);
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < soil.size(); ++i)
    if (std::abs(soil.x[i] - 0.3) < 0.4) {
      sum += std::pow(soil.vx[i] - bagnold(soil.y[i]), 2);
      ++n;
    }
  EXPECT_GT(n, 50);
  const EnergyBudget e = simulation.energy();
  EXPECT_GT(e.viscosity, 0.05 * e.friction) << "mu(I) takes its share";
  EXPECT_LT(std::abs(e.created() - given), 0.01 * e.gravity_work());
  return std::sqrt(sum / n) / bagnold(depth);
}

TEST(InertialLayer, ElasticYieldKeepsAndFindsBagnoldsProfile) {
  EXPECT_LT(error_of_bagnold(Yield::elastic, Integrator::rk2, 1.0), 0.17);
  EXPECT_LT(error_of_bagnold(Yield::elastic, Integrator::rk2, 0.5), 0.1);
}
TEST(InertialLayer, RegularizedYieldKeepsBagnoldsProfile) {
  EXPECT_LT(error_of_bagnold(Yield::regularized, Integrator::rk2, 1.0), 0.17);
}
TEST(InertialLayer, LeapfrogKeepsBagnoldsProfile) {
  EXPECT_LT(error_of_bagnold(Yield::elastic, Integrator::leapfrog, 1.0), 0.17);
}

/// Soil of a material with mu(I) on a flat bed, 2 m high.
Model column_of_grains(const InertialFriction<>& of) {
  Model m = column(2.0, 2.0, 0.1);
  m.materials[0].mu_i = of;
  return m;
}

TEST(InertialLayer, TheTimeStepIsBoundedByTheLargestViscosityAtThePressuresOfTheRun) {
  // A weight of rho g H and an impact of rho 2 g H: eta = sqrt(3 rho g H rho_s) d delta_mu/I_0, dt = h^2 rho/(8 eta).
  InertialFriction<> coarse{.delta_mu = 0.3, .I_0 = 0.003, .mu_inf = 0.05, .d = 0.5, .rho_s = 2500};
  const double eta = std::sqrt(3.0 * 2000 * 9.81 * 2.0 * 2500) * 0.5 * 0.3 / 0.003, h = 1.5 * 0.1;
  EXPECT_NEAR(first_step(column_of_grains(coarse)), h * h * 2000 / (8 * eta), 1e-9 * h * h * 2000 / eta);
  coarse.d = 1e-4;
  EXPECT_EQ(first_step(column_of_grains(coarse)), first_step(column(2.0, 2.0, 0.1))) << "fine grains do not bound it";
}

}  // namespace
}  // namespace talus

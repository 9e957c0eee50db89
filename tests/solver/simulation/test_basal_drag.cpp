// Voellmy friction and stretches of the bed, against closed forms of a slab on an incline.

#include <gtest/gtest.h>

#include <cmath>

#include "slabs.hpp"

namespace talus {
namespace {

using namespace testing_support;

constexpr Slab slab{20 * degree, 50.0, 1.0, 0.2};
constexpr double mu_angle = 10 * degree, xi = 100.0;

/// Soil too strong to shear inside.
Model sliding(std::optional<double> turbulence) {
  Model m = slab.model(60.0);
  m.materials = {{"debris", 2000, 40 * degree, 0, 0}};
  m.boundaries[0].slip = WallSlip::friction;
  m.boundaries[0].phi = mu_angle;
  m.boundaries[0].xi = turbulence;
  m.numerics.c_s = 100.0;
  return m;
}

/// Starts all soil at a speed down the plane [m/s] and runs it to m.time.end.
Motion run_from(Model m, double speed) {
  Simulation simulation(m, plan_particles(m));
  CheckpointState state = simulation.state();
  for (std::size_t i = 0; i < simulation.soil().size(); ++i) {
    state.reals["vx"][i] = speed * std::cos(slab.theta);
    state.reals["vy"][i] = -speed * std::sin(slab.theta);
  }
  simulation.restore(state);
  while (!simulation.finished()) simulation.step(m.time.end);
  return motion(slab, simulation);
}

TEST(BasalDrag, TermIsTheSquareOfTheSpeedOverXi) {
  EXPECT_DOUBLE_EQ(turbulent_friction(2000, 9.81, 3.0, 500), 2000 * 9.81 * 9.0 / 500);
}

// rho H dv/dt = rho g H (sin - mu cos) - rho g v^2/xi: v = v_t tanh(t/T + atanh(v_0/v_t)),
// v_t^2 = xi H (sin - mu cos), T = xi H/(g v_t).
double terminal_speed() {
  return std::sqrt(xi * slab.thickness * (std::sin(slab.theta) - std::tan(mu_angle) * std::cos(slab.theta)));
}
double speed_after(double t, double v_0) {
  const double v_t = terminal_speed(), T = xi * slab.thickness / (standard_gravity * v_t);
  return v_0 < v_t ? v_t * std::tanh(t / T + std::atanh(v_0 / v_t)) : v_t / std::tanh(t / T + std::atanh(v_t / v_0));
}

TEST(BasalDrag, SlabFindsTheTerminalSpeedFromBelowAndFromAbove) {
  Model m = sliding(xi);
  m.time.end = 3.0;
  for (const double share : {0.6, 1.4}) {
    const double v_0 = share * terminal_speed();
    EXPECT_NEAR(run_from(m, v_0).speed / speed_after(3.0, v_0), 1.0, 0.025) << share;
  }
}

TEST(BasalDrag, WithoutTheTermTheSlabGoesOnAccelerating) {
  Model m = sliding({});
  m.time.end = 3.0;
  EXPECT_GT(run_from(m, terminal_speed()).speed, 1.5 * terminal_speed());
}

TEST(BasalDrag, SinglePrecisionAgreesWithThePlainLoops) {
  Model m = sliding(xi);
  m.time.end = 0.2;
  const Motion single = run_from(m, 3.0);
  m.numerics.precision = Precision::full;
  const Motion plain = run_from(m, 3.0);
  EXPECT_NEAR(single.speed, plain.speed, 1e-4);
}

TEST(BasalDrag, ACheckpointKeepsTheBits) {
  Model m = sliding(xi);
  m.time.end = 0.6;
  Simulation whole(m, plan_particles(m)), resumed(m, plan_particles(m));
  while (whole.time() < 0.3) whole.step(m.time.end);
  resumed.restore(whole.state());
  while (!whole.finished()) whole.step(m.time.end);
  while (!resumed.finished()) resumed.step(m.time.end);
  EXPECT_EQ(whole.result().digest, resumed.result().digest);
}

TEST(BasalDrag, WorkOfTheTermIsInTheBalance) {
  Model m = sliding(xi);
  m.time.end = 3.0;
  Simulation simulation(m, plan_particles(m));
  while (!simulation.finished()) simulation.step(m.time.end);
  const EnergyBudget e = simulation.energy();
  EXPECT_LT(std::abs(e.created()), 0.01 * e.gravity_work());
}

// The friction of a stretch holds on it as that of the bed does, and nowhere else.
TEST(Stretches, ASlabMeetsTheFrictionOfTheStretchItLiesOn) {
  const auto acceleration_on = [](double phi_bed, std::vector<WallStretch> stretches) {
    Model m = sliding({});
    m.boundaries[0].phi = phi_bed;
    m.boundaries[0].stretches = std::move(stretches);
    return late_acceleration(slab, m, 1.0);
  };
  const WallStretch everywhere{-1e3, 1e3, 15 * degree}, below{100.0, 1e3, 15 * degree};
  const double all_15 = acceleration_on(15 * degree, {});
  EXPECT_EQ(acceleration_on(5 * degree, {everywhere}), all_15) << "the same run";
  EXPECT_EQ(acceleration_on(15 * degree, {{100.0, 1e3, 0.0}}), all_15) << "out of reach";
  EXPECT_GT(acceleration_on(5 * degree, {below}), all_15 + 1.0);
  const double expected = standard_gravity * (std::sin(slab.theta) - std::cos(slab.theta) * std::tan(15 * degree));
  EXPECT_NEAR(all_15, expected, 0.05 * standard_gravity);
}

TEST(Stretches, TheBoundarysOwnFrictionHoldsBetweenThem) {
  const std::vector<Boundary> boundaries{{"bed", {}, WallSlip::no_slip, 0, {}, {}, {{1, 2, 0.1}, {4, 5, 0.2}}},
                                         {"wall", {}, WallSlip::no_slip, 0, {}, {}, {{0, 9, 0.3}}}};
  EXPECT_EQ(friction_index(boundaries, 0, 0.5), 0u);
  EXPECT_EQ(friction_index(boundaries, 0, 1.0), 2u);
  EXPECT_EQ(friction_index(boundaries, 0, 2.0), 0u);
  EXPECT_EQ(friction_index(boundaries, 0, 4.5), 3u);
  EXPECT_EQ(friction_index(boundaries, 1, 4.5), 4u);
  EXPECT_EQ(friction_index(boundaries, 1, 9.5), 1u);
  const std::vector<WallFriction> of = wall_friction(boundaries);
  ASSERT_EQ(of.size(), 5u);
  EXPECT_DOUBLE_EQ(of[3].tan_phi, std::tan(0.2));
  EXPECT_EQ(of[3].slip, WallSlip::friction);
  EXPECT_EQ(of[0].slip, WallSlip::no_slip);
}

}  // namespace
}  // namespace talus

// Loss of strength: the plastic strain of a particle, the work of a shear band at two spacings, checkpoints.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "material/softening.hpp"
#include "slabs.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// A slab of clay 2 m thick on 20 degrees, whose peak strength is below what its weight asks for at the base.
constexpr double displacement = 0.5, density = 1800;
Slab slab(double dx) { return {20 * degree, 40.0, 2.0, dx}; }
double driving_stress() { return density * standard_gravity * 2.0 * std::sin(20 * degree); }

/// A band that begins to shear at 0.9 of the driving stress and keeps 0.5 of it.
Model softening_slab(double dx, Integrator integrator = Integrator::leapfrog) {
  Model m = slab(dx).model(10.0);
  m.materials = {{"clay", density, 0, 0.9 * driving_stress(), 0}};
  m.materials[0].undrained = true;
  m.materials[0].softening = Softening{.c = 0.5 * driving_stress(), .displacement = displacement};
  m.numerics.integrator = integrator;
  return m;
}

/// What a shear band at the base takes until the slab has moved by D, by the displacement and the speed of its middle:
/// per metre of band, rho H (g sin(theta) D - v^2/2). [J/m2]
/// @param width  of the band, as stated [m]
double work_of_band(double dx, double until, std::optional<double> width = {}) {
  Model m = softening_slab(dx);
  m.materials[0].softening->band_width = width;
  m.time.end = 5.0;
  Simulation simulation(m, plan_particles(m));
  Motion now;
  while (!simulation.finished() && now.distance < until) {
    for (int k = 0; k < 5; ++k) simulation.step(m.time.end);
    now = motion(slab(dx), simulation);
  }
  EXPECT_GE(now.distance, until);
  const double height = 2.0;
  return density * height * (standard_gravity * std::sin(20 * degree) * now.distance - 0.5 * now.speed * now.speed);
}

// Closed form until the displacement D = 1.5 x 0.5 m: (0.9 + 0.5)/2 of the driving stress over 0.5 m, then 0.5 of it.
TEST(StrengthLoss, WorkOfAShearBandDoesNotDependOnTheSpacing) {
  const double closed = driving_stress() * (0.7 * displacement + 0.5 * 0.5 * displacement);
  const double coarse = work_of_band(0.25, 1.5 * displacement), fine = work_of_band(0.125, 1.5 * displacement);
  RecordProperty("coarse", std::to_string(coarse / closed));
  RecordProperty("fine", std::to_string(fine / closed));
  EXPECT_NEAR(coarse / closed, 1.0, 0.1);
  EXPECT_NEAR(fine / closed, 1.0, 0.1);
  EXPECT_NEAR(coarse / fine, 1.0, 0.08);
}

// Along the bed the average has soil on one side only, and a part of the displacement is slip along the bed: the two
// nearly cancel.
TEST(StrengthLoss, WorkOfABandOfStatedWidthDoesNotDependOnTheSpacing) {
  const double closed = driving_stress() * (0.7 * displacement + 0.5 * 0.5 * displacement);
  const double coarse = work_of_band(0.25, 1.5 * displacement, 1.0),
               fine = work_of_band(0.125, 1.5 * displacement, 1.0);
  RecordProperty("coarse", std::to_string(coarse / closed));
  RecordProperty("fine", std::to_string(fine / closed));
  EXPECT_NEAR(coarse / closed, 1.0, 0.1);
  EXPECT_NEAR(coarse / fine, 1.0, 0.05);
}

/// Cohesion as it is, by id.
std::vector<double> cohesion(const Simulation& s) { return s.frame().cohesion; }

TEST(StrengthLoss, StrengthFollowsThePlasticStrainOfEachParticle) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::rk2}) {
    Model m = softening_slab(0.25, integrator);
    m.time.end = 0.6;
    Simulation simulation(m, plan_particles(m));
    while (!simulation.finished()) simulation.step(m.time.end);
    const std::vector<double> strain = simulation.state().reals.at("plastic_strain"), c = cohesion(simulation);
    const double gamma_r = displacement / (shear_band_spacings * 0.25);
    ASSERT_EQ(strain.size(), simulation.soil().size());
    EXPECT_GT(std::ranges::max(strain), 0.05);
    for (std::size_t id = 0; id < strain.size(); ++id)
      EXPECT_NEAR(c[id], driving_stress() * (0.9 - 0.4 * std::min(1.0, strain[id] / gamma_r)), 1e-9 * driving_stress());
  }
}

TEST(StrengthLoss, SoilThatDoesNotYieldKeepsItsStrength) {
  Model m = softening_slab(0.25);
  m.materials[0].c = 3.0 * driving_stress();  // weight that acts at once shears up to twice as much as weight at rest
  m.time.end = 1.0;
  Simulation simulation(m, plan_particles(m));
  while (!simulation.finished()) simulation.step(m.time.end);
  const Frame f = simulation.frame();
  for (std::size_t id = 0; id < f.n_soil; ++id) {
    if (!slab(0.25).in_the_middle(f.position[id] - f.displacement[id])) continue;
    EXPECT_EQ(f.cohesion[id], m.materials[0].c);
  }
}

TEST(StrengthLoss, ACheckpointKeepsTheBits) {
  Model m = softening_slab(0.25);
  m.time.end = 1.0;
  m.materials[0].softening->band_width = 1.0;  // averaged every ten steps
  Simulation whole(m, plan_particles(m)), resumed(m, plan_particles(m));
  while (whole.time() < 0.5 || whole.steps() % 10 != 5) whole.step(m.time.end);
  resumed.restore(whole.state());
  while (!whole.finished()) whole.step(m.time.end);
  while (!resumed.finished()) resumed.step(m.time.end);
  EXPECT_EQ(whole.result().digest, resumed.result().digest);
  EXPECT_EQ(whole.state().reals.at("plastic_strain"), resumed.state().reals.at("plastic_strain"));
  CheckpointState without = whole.state();
  without.reals.erase("plastic_strain");
  EXPECT_THROW(resumed.restore(without), IoError);
}

TEST(StrengthLoss, ARunWithoutSofteningHasNoStrains) {
  const Model m = column(1.0, 1.0, 0.25);
  EXPECT_EQ(Simulation(m, plan_particles(m)).state().reals.count("plastic_strain"), 0u);
}

TEST(StrengthLoss, SinglePrecisionSoftensAsThePlainLoops) {
  Model m = softening_slab(0.25);
  m.time.end = 0.3;
  double strain[2];
  for (const Precision precision : {Precision::single, Precision::full}) {
    m.numerics.precision = precision;
    Simulation simulation(m, plan_particles(m));
    while (!simulation.finished()) simulation.step(m.time.end);
    const CheckpointState end = simulation.state();
    double sum = 0.0;
    for (const double gamma : end.reals.at("plastic_strain")) sum += gamma;
    strain[precision == Precision::full] = sum;
  }
  EXPECT_GT(strain[0], 1.0);
  EXPECT_NEAR(strain[0] / strain[1], 1.0, 1e-2);
}

TEST(StrengthLoss, EnergyBalanceStaysClosed) {
  Model m = softening_slab(0.25);
  m.time.end = 1.5;
  Simulation simulation(m, plan_particles(m));
  while (!simulation.finished()) simulation.step(m.time.end);
  const EnergyBudget e = simulation.energy();
  EXPECT_LT(std::abs(e.created()), 0.01 * e.gravity_work());
  EXPECT_GT(e.friction, 0.3 * e.gravity_work());
}

TEST(StrengthLoss, ResidualFrictionIsThatOfTotalStressToo) {
  Model m = slab(0.25).model(5.0);
  m.materials = {{"clay shale", density, 18 * degree, 0, 0}};
  m.materials[0].r_u = 0.3;
  m.materials[0].softening = Softening{.phi = 10 * degree, .shear_strain = 0.05};
  m.time.end = 1.0;
  Simulation simulation(m, plan_particles(m));
  while (!simulation.finished()) simulation.step(m.time.end);
  const double lambda = 0.3 / std::pow(std::cos(20 * degree), 2);
  const Frame f = simulation.frame();
  double least = 1.0;
  for (std::size_t id = 0; id < f.n_soil; ++id)
    if (slab(0.25).in_the_middle(f.position[id] - f.displacement[id])) least = std::min(least, f.tan_phi[id]);
  EXPECT_NEAR(least, (1.0 - lambda) * std::tan(10 * degree), 1e-6);
}

}  // namespace
}  // namespace talus

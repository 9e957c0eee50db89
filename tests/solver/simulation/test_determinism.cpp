// The same bits for any number of threads and across a checkpoint.

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "models.hpp"
#include "simulation/observables.hpp"
#include "simulation/simulation.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

using namespace testing_support;

std::string digest_after(const Model& m, int steps, int threads) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  Simulation simulation(m, plan_particles(m));
  for (int k = 0; k < steps; ++k) simulation.step(m.time.end);
  omp_set_num_threads(before);
  return digest(simulation.soil());
}

TEST(Determinism, OneTwoAndThreeThreadsGiveTheSameBits) {
  for (const auto filter : {DensityFilter::delta_sph, DensityFilter::shepard}) {
    Model m = collapse(0.05);
    m.numerics.density_filter = filter;
    m.numerics.filter_interval = 7;
    const std::string one = digest_after(m, 60, 1);
    EXPECT_EQ(digest_after(m, 60, 2), one);
    EXPECT_EQ(digest_after(m, 60, 3), one);
  }
}

TEST(Determinism, ARestoredRunGoesOnWithTheSameBits) {
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog})
    for (const auto filter : {DensityFilter::delta_sph, DensityFilter::shepard}) {
      Model m = collapse(0.05);
      m.numerics.integrator = integrator;
      m.numerics.density_filter = filter;
      m.numerics.filter_interval = 9;
      m.time.end = 0.4;
      Simulation whole(m, plan_particles(m));
      while (!whole.finished()) whole.step(m.time.end);
      Simulation first(m, plan_particles(m));
      for (int k = 0; k < 83; ++k) first.step(m.time.end);
      Simulation second(m, plan_particles(m));
      second.restore(first.state());
      while (!second.finished()) second.step(m.time.end);
      EXPECT_EQ(second.result().digest, whole.result().digest);
      EXPECT_EQ(second.steps(), whole.steps());
      EXPECT_EQ(second.result().evaluations, whole.result().evaluations);
      EXPECT_EQ(second.result().max_speed, whole.result().max_speed);
    }
}

/// Densities and viscosities that vary from particle to particle.
SoilProperties varied(const Model& m, const ParticlePlan& plan) {
  SoilProperties properties = material_properties(m, plan);
  for (std::size_t i = 0; i < plan.soil.size(); ++i) {
    properties.rho0.push_back(m.materials[0].rho0 * (1.0 + 0.1 * std::sin(0.9 * static_cast<double>(i))));
    properties.eta.push_back(40.0 + 30.0 * std::cos(1.3 * static_cast<double>(i)));
  }
  return properties;
}

TEST(Determinism, ARestoredRunKeepsPropertiesOfEachParticle) {
  for (const auto precision : {Precision::single, Precision::full}) {
    Model m = collapse(0.05);
    m.numerics.precision = precision;
    m.time.end = 0.3;
    const ParticlePlan plan = plan_particles(m);
    const SoilProperties properties = varied(m, plan);
    Simulation whole(m, plan, properties);
    while (!whole.finished()) whole.step(m.time.end);
    Simulation first(m, plan, properties);
    for (int k = 0; k < 61; ++k) first.step(m.time.end);
    Simulation second(m, plan, properties);
    second.restore(first.state());
    while (!second.finished()) second.step(m.time.end);
    EXPECT_EQ(second.result().digest, whole.result().digest);
    Simulation uniform(m, plan);
    EXPECT_THROW(uniform.restore(CheckpointState{}), IoError);
    while (!uniform.finished()) uniform.step(m.time.end);
    EXPECT_NE(uniform.result().digest, whole.result().digest);
  }
}

TEST(Determinism, ThreadsGiveTheSameBitsWithPropertiesOfEachParticle) {
  const Model m = collapse(0.05);
  const ParticlePlan plan = plan_particles(m);
  std::string digests[2];
  for (int k = 0; k < 2; ++k) {
    omp_set_num_threads(1 + k);
    Simulation s(m, plan, varied(m, plan));
    for (int step = 0; step < 60; ++step) s.step(m.time.end);
    digests[k] = s.result().digest;
  }
  omp_set_num_threads(1);
  EXPECT_EQ(digests[0], digests[1]);
}

TEST(Determinism, ListsOfNeighboursAreRenewedBeforeTheyMissAny) {
  // A restored run rebuilds its lists; if those of the other were due for a rebuild, the bits would differ.
  Model m = collapse(0.05);
  m.boundaries.front().slip = WallSlip::free_slip;
  m.materials[0].phi = 0.05;
  m.time.end = 0.6;
  Simulation whole(m, plan_particles(m)), second(m, plan_particles(m));
  while (!whole.finished()) {
    second.restore(whole.state());
    for (int k = 0; k < 4; ++k) {
      whole.step(m.time.end);
      second.step(m.time.end);
    }
    ASSERT_EQ(digest(second.soil()), digest(whole.soil())) << "after step " << whole.steps();
  }
}

TEST(Determinism, AStateOfAnotherModelIsRefused) {
  Simulation coarse(collapse(0.1), plan_particles(collapse(0.1))), fine(collapse(0.05), plan_particles(collapse(0.05)));
  EXPECT_THROW(fine.restore(coarse.state()), IoError);
  CheckpointState spoilt = fine.state();
  spoilt.integers["counters"][0] += 1;
  EXPECT_THROW(fine.restore(spoilt), IoError);
}

}  // namespace
}  // namespace talus

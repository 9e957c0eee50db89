#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <string>

#include "integrate/plain_flow.hpp"
#include "integrate/vectorised_flow.hpp"
#include "random_soil.hpp"

namespace talus {
namespace {

/// One particle in a smooth nonlinear problem with a known solution:
///   x'' = -x (so x = cos t), y'' = -2 y'  (y = (1 - e^-2t)/2), rho' = -x rho (rho = e^-sin t), txx' = -txx + x.
Soil one_particle() {
  Soil s;
  for_each_real(s, [](const char*, auto& a) { a.assign(1, 0.0); });
  s.material = {0};
  s.id = {0};
  s.n_active = 1;
  s.x[0] = 1;
  s.vy[0] = 1;
  s.rho[0] = 1;
  s.txx[0] = 0.5;
  return s;
}
void rates(Soil& s) {
  s.ax[0] = -s.x[0];
  s.ay[0] = -2 * s.vy[0];
  s.drho[0] = -s.x[0] * s.rho[0];
  s.dtxx[0] = -s.txx[0] + s.x[0];
}
void step(Integrator integrator, Soil& soil, Soil& start, double dt, const Evaluate& evaluate) {
  PlainState state(soil, start, evaluate);
  advance(integrator, state, dt);
}

struct Errors {
  double x, y, rho, t;
};
Errors errors_after_one_second(Integrator integrator, int n) {
  Soil s = one_particle();
  Soil start;
  rates(s);  // the leapfrog predicts with the rates of the step before
  for (int k = 0; k < n; ++k) step(integrator, s, start, 1.0 / n, rates);
  const double txx = 0.5 * (std::cos(1.0) + std::sin(1.0));  // particular solution of t' = -t + cos, homogeneous part 0
  return {std::abs(s.x[0] - std::cos(1.0)), std::abs(s.y[0] - 0.5 * (1 - std::exp(-2.0))),
          std::abs(s.rho[0] - std::exp(-std::sin(1.0))), std::abs(s.txx[0] - txx)};
}

void expect_second_order(Integrator integrator) {
  const Errors coarse = errors_after_one_second(integrator, 200), fine = errors_after_one_second(integrator, 400);
  EXPECT_NEAR(std::log2(coarse.x / fine.x), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.y / fine.y), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.rho / fine.rho), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.t / fine.t), 2.0, 0.1);
  EXPECT_LT(fine.x, 1e-4);
}

TEST(Integrator, Rk2IsOfSecondOrder) { expect_second_order(Integrator::rk2); }
TEST(Integrator, LeapfrogIsOfSecondOrder) { expect_second_order(Integrator::leapfrog); }

TEST(Integrator, EvaluationsPerStep) {
  Soil s = one_particle();
  Soil start;
  int calls = 0;
  const Evaluate count = [&](Soil&) { ++calls; };
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    calls = 0;
    step(integrator, s, start, 0.1, count);
    EXPECT_EQ(calls, evaluations_per_step(integrator));
  }
  EXPECT_EQ(evaluations_per_step(Integrator::rk2), 2);
  EXPECT_EQ(evaluations_per_step(Integrator::leapfrog), 1);
}

TEST(Integrator, FreeFallIsExact) {
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    Soil s = one_particle();
    Soil start;
    const Evaluate gravity = [](Soil& soil) {
      soil.ax[0] = 0;
      soil.ay[0] = -9.81;
      soil.drho[0] = 0;
      soil.dtxx[0] = 0;
    };
    for (int k = 0; k < 10; ++k) step(integrator, s, start, 0.1, gravity);
    EXPECT_NEAR(s.y[0], 1.0 - 0.5 * 9.81, 1e-12);
    EXPECT_NEAR(s.vy[0], 1.0 - 9.81, 1e-12);
  }
}

TEST(Integrator, InactiveParticlesStay) {
  Soil s = one_particle();
  s.n_active = 0;
  Soil start;
  const Evaluate nothing = [](Soil&) {};
  step(Integrator::rk2, s, start, 0.1, nothing);
  EXPECT_EQ(s.y[0], 0.0);
}

/// A random soil over a wall after some steps, by id: by the plain loops, or by the vectorised ones.
Soil after_steps(Integrator integrator, bool vectorised, double* largest_displacement, int columns = 14) {
  using namespace testing_support;
  const double dx = 0.1, dt = 1e-4;
  FlowConstants k = constants(dx, {0.0, -9.81}, {{"a", 2000, 0.5, 700, 30}, {"b", 1900, 0.3, 100, 90}});
  k.numerics.integrator = integrator;
  Soil soil = random_soil(columns, 9, dx, 11, 2);
  WallParticles walls = flat_walls(columns, dx);
  ParticleCells cells;
  cells.soil = sorted(soil, 3 * k.h);
  cells.walls = sorted(walls, 3 * k.h);
  std::unique_ptr<Flow> flow;
  if (vectorised)
    flow = std::make_unique<VectorisedFlow>(k, soil);
  else
    flow = std::make_unique<PlainFlow>(k, soil);
  flow->rebuild_neighbour_lists(soil, walls, cells, 0.0, 0.1 * k.h);
  for (int n = 0; n < 10; ++n) {
    const Soil before = soil;
    const StepExtrema extrema = flow->step(soil, walls, cells, dt);
    double displacement = 0.0, speed = 0.0;
    for (std::size_t i = 0; i < soil.size(); ++i) {
      displacement = std::max(displacement, norm(soil.position(i) - before.position(i)));
      speed = std::max(speed, norm(soil.velocity(i)));
    }
    EXPECT_NEAR(extrema.max_speed, speed, 1e-12 * speed);
    if (vectorised) {
      EXPECT_NEAR(extrema.max_displacement, displacement, 1e-6 * displacement);
    }
    *largest_displacement = displacement;
  }
  return soil;
}

/// With V = m/rho alone each would lose m W(r) = 480 kg/m3 on the way, more than it has.
TEST(Integrator, LooseParticlesThatFlyApartKeepADensity) {
  using namespace testing_support;
  const double dx = 0.1, dt = 1e-4;
  const FlowConstants k = constants(dx, {0.0, 0.0}, {{"a", 2000, 0.5, 0, 0}, {"b", 2000, 0.5, 0, 0}});
  for (const bool vectorised : {false, true}) {
    Soil soil = random_soil(2, 1, dx, 11, 1);
    WallParticles walls = flat_walls(2, dx);
    for (const std::size_t i : {0, 1}) {
      const double side = i == 0 ? -1.0 : 1.0;
      soil.x[i] = 0.02 * side;
      soil.y[i] = 5.0;
      soil.vx[i] = 2.0 * side;
      soil.vy[i] = 0.0;
      soil.m[i] = 2000.0 * dx * dx;
      soil.rho[i] = 400.0;
      soil.c[i] = soil.txx[i] = soil.tyy[i] = soil.txy[i] = 0.0;
    }
    const std::unique_ptr<Flow> flow = vectorised ? std::unique_ptr<Flow>(std::make_unique<VectorisedFlow>(k, soil))
                                                  : std::make_unique<PlainFlow>(k, soil);
    for (int n = 0; n < 1000; ++n) {
      ParticleCells cells;
      cells.soil = sorted(soil, 3 * k.h);
      cells.walls = sorted(walls, 3 * k.h);
      flow->rebuild_neighbour_lists(soil, walls, cells, 0.0, 0.1 * k.h);
      flow->step(soil, walls, cells, dt);
    }
    EXPECT_GT(norm(soil.position(0) - soil.position(1)), 2.0 * k.h);
    for (const double rho : soil.rho) {
      EXPECT_GT(rho, 20.0) << vectorised;
      EXPECT_LT(rho, 200.0) << vectorised;
    }
  }
}

/// OpenMP may give fewer threads than asked for: here one, since a region within a region gets no more.
TEST(Integrator, VectorisedStepsDoNotDependOnTheThreadsThatThereAre) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(3);
  double displacement = 0.0;
  const Soil alone = after_steps(Integrator::rk2, true, &displacement, 200);
  Soil within;
#pragma omp parallel num_threads(2)
#pragma omp single
  {
    omp_set_num_threads(3);
    within = after_steps(Integrator::rk2, true, &displacement, 200);
  }
  omp_set_num_threads(before);
  EXPECT_EQ(within.vx, alone.vx);
  EXPECT_EQ(within.rho, alone.rho);
}

/// What a step says of its particles is theirs alone, wherever the threads' shares end: here every particle is brought
/// to rest by an acceleration, which those beyond a share's end must not lend to it.
TEST(Integrator, ExtremesOfAStepAreThoseOfItsParticles) {
  using namespace testing_support;
  const int before = omp_get_max_threads();
  for (const int threads : {1, 2, 3, 5, 7}) {
    omp_set_num_threads(threads);
    const double dx = 0.1, dt = 1e-3;
    FlowConstants k = constants(dx);
    k.numerics.integrator = Integrator::leapfrog;
    Soil soil = random_soil(200, 9, dx, 11);
    WallParticles walls = flat_walls(200, dx);
    ParticleCells cells;
    cells.soil = sorted(soil, 3 * k.h);
    cells.walls = sorted(walls, 3 * k.h);
    std::ranges::fill(soil.vx, 0.0);
    std::ranges::fill(soil.vy, 0.0);
    VectorisedFlow flow(k, soil);
    flow.rebuild_neighbour_lists(soil, walls, cells, 0.0, 0.1 * k.h);
    flow.evaluate(soil, walls, 0.0, true);
    flow.read_evaluation(soil, soil);
    for (std::size_t i = 0; i < soil.size(); ++i) {
      soil.vx[i] = -dt * soil.ax[i];
      soil.vy[i] = -dt * soil.ay[i];
    }
    flow.state_changed();
    const StepExtrema extrema = flow.step(soil, walls, cells, dt);
    double speed = 0.0, moved = 0.0, left = 1e300, right = -1e300;
    for (std::size_t i = 0; i < soil.size(); ++i) {
      speed = std::max(speed, norm(soil.velocity(i)));
      moved = std::max(moved, std::hypot(soil.x[i] - soil.x_sorted[i], soil.y[i] - soil.y_sorted[i]));
      left = std::min(left, soil.x[i]);
      right = std::max(right, soil.x[i]);
    }
    EXPECT_NEAR(extrema.max_speed, speed, 1e-12 * speed) << threads << " threads";
    EXPECT_NEAR(extrema.moved_since_sort, moved, 1e-12 * moved) << threads << " threads";
    EXPECT_EQ(extrema.leftmost, left);
    EXPECT_EQ(extrema.rightmost, right);
    EXPECT_TRUE(extrema.all_finite);
  }
  omp_set_num_threads(before);
}

TEST(Integrator, VectorisedStepsEqualThePlainOnes) {
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    double displacement = 0.0;
    const Soil a = after_steps(integrator, false, &displacement), b = after_steps(integrator, true, &displacement);
    ASSERT_GT(displacement, 1e-4);
    for_each_state(a, [&](const std::string& name, const auto& expected) {
      double size = 0.0;
      for (const double value : expected) size = std::max(size, std::abs(value));
      for_each_state(b, [&](const std::string& other, const auto& actual) {
        if (name != other) return;
        for (std::size_t i = 0; i < a.size(); ++i)
          ASSERT_NEAR(actual[i], expected[i], 3e-6 * size) << name << " of " << i;
      });
    });
  }
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <string>

#include "integrate/integrator.hpp"
#include "random_soil.hpp"
#include "sph/vectorised_flow.hpp"

namespace talus {
namespace {

/// One particle in a smooth nonlinear problem with a known solution:
///   x'' = -x (so x = cos t), y'' = -2 y'  (y = (1 - e^-2t)/2), rho' = -x rho (rho = e^-sin t), txx' = -txx + x.
Soil one_particle() {
  Soil s;
  for_each_real(s, [](const char*, auto& a) { a.assign(1, 0.0); });
  s.material = {0}, s.id = {0}, s.n_active = 1;
  s.x[0] = 1, s.vy[0] = 1, s.rho[0] = 1, s.txx[0] = 0.5;
  return s;
}
void rates(Soil& s) {
  s.ax[0] = -s.x[0], s.ay[0] = -2 * s.vy[0];
  s.drho[0] = -s.x[0] * s.rho[0], s.dtxx[0] = -s.txx[0] + s.x[0];
}
using Step = void (*)(Soil&, StepStart&, double, const Evaluate&);
constexpr Step rk2 = step_rk2, leapfrog = step_leapfrog;

struct Errors {
  double x, y, rho, t;
};
Errors errors_after_one_second(Step step, int n) {
  Soil s = one_particle();
  StepStart start;
  rates(s);  // the leapfrog predicts with the rates of the step before
  for (int k = 0; k < n; ++k) step(s, start, 1.0 / n, rates);
  const double txx = 0.5 * (std::cos(1.0) + std::sin(1.0));  // particular solution of t' = -t + cos, homogeneous part 0
  return {std::abs(s.x[0] - std::cos(1.0)), std::abs(s.y[0] - 0.5 * (1 - std::exp(-2.0))),
          std::abs(s.rho[0] - std::exp(-std::sin(1.0))), std::abs(s.txx[0] - txx)};
}

void expect_second_order(Step step) {
  const Errors coarse = errors_after_one_second(step, 200), fine = errors_after_one_second(step, 400);
  EXPECT_NEAR(std::log2(coarse.x / fine.x), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.y / fine.y), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.rho / fine.rho), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.t / fine.t), 2.0, 0.1);
  EXPECT_LT(fine.x, 1e-4);
}

TEST(Integrator, Rk2IsOfSecondOrder) { expect_second_order(rk2); }
TEST(Integrator, LeapfrogIsOfSecondOrder) { expect_second_order(leapfrog); }

TEST(Integrator, EvaluationsPerStep) {
  Soil s = one_particle();
  StepStart start;
  int calls = 0;
  const Evaluate count = [&](Soil&) { ++calls; };
  step_rk2(s, start, 0.1, count);
  EXPECT_EQ(calls, 2);
  step_leapfrog(s, start, 0.1, count);
  EXPECT_EQ(calls, 3);
}

TEST(Integrator, FreeFallIsExact) {
  for (const auto step : {rk2, leapfrog}) {
    Soil s = one_particle();
    StepStart start;
    const Evaluate gravity = [](Soil& soil) { soil.ax[0] = 0, soil.ay[0] = -9.81, soil.drho[0] = 0, soil.dtxx[0] = 0; };
    for (int k = 0; k < 10; ++k) step(s, start, 0.1, gravity);
    EXPECT_NEAR(s.y[0], 1.0 - 0.5 * 9.81, 1e-12);
    EXPECT_NEAR(s.vy[0], 1.0 - 9.81, 1e-12);
  }
}

TEST(Integrator, InactiveParticlesStay) {
  Soil s = one_particle();
  s.n_active = 0;
  StepStart start;
  step_rk2(s, start, 0.1, [](Soil&) {});
  EXPECT_EQ(s.y[0], 0.0);
}

/// A random soil over a wall after some steps, by id: by the plain loops, or by the vectorised ones.
Soil after_steps(Integrator integrator, bool vectorised, double* way, int columns = 14) {
  using namespace testing_support;
  const double dx = 0.1, dt = 1e-4;
  FlowConstants k = constants(dx, {0.0, -9.81}, {{"a", 2000, 0.5, 700, 30}, {"b", 1900, 0.3, 100, 90}});
  Soil soil = random_soil(columns, 9, dx, 11, 2);
  WallParticles walls = flat_walls(columns, dx);
  const CellList soil_cells = sorted(soil, 3 * k.h), wall_cells = sorted(walls, 3 * k.h);
  VectorisedFlow flow(k, soil);
  flow.renew(soil, walls, soil_cells, wall_cells, 0.0, 0.1 * k.h);
  RightHandSide rhs(k);
  StepStart start;
  const Evaluate evaluate = [&](Soil& s) { rhs.evaluate(s, walls, soil_cells, wall_cells); };
  const bool is_rk2 = integrator == Integrator::rk2;
  for (int n = 0; n < 10; ++n) {
    const Soil before = soil;
    if (vectorised) {
      const double claimed = flow.step(soil, walls, dt, is_rk2).way;
      double gone = 0.0;
      for (std::size_t i = 0; i < soil.size(); ++i) gone = std::max(gone, norm(soil.position(i) - before.position(i)));
      EXPECT_NEAR(claimed, gone, 1e-6 * gone);
      *way = gone;
    } else {
      (is_rk2 ? rk2 : leapfrog)(soil, start, dt, evaluate);
    }
  }
  return soil;
}

/// OpenMP may give fewer threads than asked for: here one, since a region within a region gets no more.
TEST(Integrator, VectorisedStepsDoNotDependOnTheThreadsThatThereAre) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(3);
  double way = 0.0;
  const Soil alone = after_steps(Integrator::rk2, true, &way, 200);
  Soil within;
#pragma omp parallel num_threads(2)
#pragma omp single
  {
    omp_set_num_threads(3);
    within = after_steps(Integrator::rk2, true, &way, 200);
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
    const FlowConstants k = constants(dx);
    Soil soil = random_soil(200, 9, dx, 11);
    WallParticles walls = flat_walls(200, dx);
    const CellList soil_cells = sorted(soil, 3 * k.h), wall_cells = sorted(walls, 3 * k.h);
    std::ranges::fill(soil.vx, 0.0), std::ranges::fill(soil.vy, 0.0);
    VectorisedFlow flow(k, soil);
    flow.renew(soil, walls, soil_cells, wall_cells, 0.0, 0.1 * k.h);
    flow.evaluate(soil, walls, 0.0, true);
    flow.unpack(soil);
    for (std::size_t i = 0; i < soil.size(); ++i) soil.vx[i] = -dt * soil.ax[i], soil.vy[i] = -dt * soil.ay[i];
    flow.state_changed();
    const Motion motion = flow.step(soil, walls, dt, false);
    double speed = 0.0, moved = 0.0, left = 1e300, right = -1e300;
    for (std::size_t i = 0; i < soil.size(); ++i) {
      speed = std::max(speed, norm(soil.velocity(i)));
      moved = std::max(moved, std::hypot(soil.x[i] - soil.x_sorted[i], soil.y[i] - soil.y_sorted[i]));
      left = std::min(left, soil.x[i]), right = std::max(right, soil.x[i]);
    }
    EXPECT_NEAR(motion.speed, speed, 1e-12 * speed) << threads << " threads";
    EXPECT_NEAR(motion.moved, moved, 1e-12 * moved) << threads << " threads";
    EXPECT_EQ(motion.leftmost, left);
    EXPECT_EQ(motion.rightmost, right);
    EXPECT_TRUE(motion.sound);
  }
  omp_set_num_threads(before);
}

TEST(Integrator, VectorisedStepsEqualThePlainOnes) {
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    double way = 0.0;
    const Soil a = after_steps(integrator, false, &way), b = after_steps(integrator, true, &way);
    ASSERT_GT(way, 1e-4);
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

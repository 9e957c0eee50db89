#include "integrate/integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
struct Errors {
  double x, y, rho, t;
};
template <class Step>
Errors errors_after_one_second(Step step, int n) {
  Soil s = one_particle();
  StepStart start;
  rates(s);  // the leapfrog predicts with the rates of the step before
  for (int k = 0; k < n; ++k) step(s, start, 1.0 / n, rates);
  const double txx = 0.5 * (std::cos(1.0) + std::sin(1.0));  // particular solution of t' = -t + cos, homogeneous part 0
  return {std::abs(s.x[0] - std::cos(1.0)), std::abs(s.y[0] - 0.5 * (1 - std::exp(-2.0))), std::abs(s.rho[0] - std::exp(-std::sin(1.0))),
          std::abs(s.txx[0] - txx)};
}

template <class Step>
void expect_second_order(Step step) {
  const Errors coarse = errors_after_one_second(step, 200), fine = errors_after_one_second(step, 400);
  EXPECT_NEAR(std::log2(coarse.x / fine.x), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.y / fine.y), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.rho / fine.rho), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.t / fine.t), 2.0, 0.1);
  EXPECT_LT(fine.x, 1e-4);
}

TEST(Integrator, Rk2IsOfSecondOrder) { expect_second_order(step_rk2); }
TEST(Integrator, LeapfrogIsOfSecondOrder) { expect_second_order(step_leapfrog); }

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
  for (const auto step : {step_rk2, step_leapfrog}) {
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

}  // namespace
}  // namespace talus

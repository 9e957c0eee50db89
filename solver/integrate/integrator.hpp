#pragma once
// One time step of the soil's state y = (x, v, rho, t): predict to the middle, evaluate there, move on from the start.

#include <functional>
#include <vector>

#include "particles/particles.hpp"

namespace talus {

/// Evaluates the rates of the soil at its present state, writing ax, ay, drho, dt**.
using Evaluate = std::function<void(Soil&)>;

/// The state at the start of a step, kept while the soil visits the middle; its memory is reused from step to step.
struct StepStart {
  std::vector<double> x, y, vx, vy, rho, txx, tyy, txy;
  void save(const Soil& soil);
};

/// Midpoint Runge-Kutta of second order, as in [Z20] 2.1: two evaluations.
///   y' = y + dt/2 f(y);  y <- y + dt f(y')
void step_rk2(Soil& soil, StepStart& start, double dt, const Evaluate& evaluate);

/// Leapfrog in its drift-kick-drift form: one evaluation. Velocities, densities and stresses are predicted to the
/// middle with the rates of the step before, so that forces depending on them stay second order.
///   x' = x + dt/2 v;  v <- v + dt a(x', v');  x <- x' + dt/2 v
void step_leapfrog(Soil& soil, StepStart& start, double dt, const Evaluate& evaluate);

}  // namespace talus

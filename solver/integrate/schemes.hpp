#pragma once
// The time integrators, each written once for every back end.
//
// A back end holds the state y = (x, v, rho, t) of the soil and offers two operations:
//   evaluate(ahead, commit)  computes the rates f(y') at the state y' that the latest rates lead to after `ahead` [s].
//                            `commit`: what the return of the elastic stress to the yield surface takes off y' is
//                            taken off y as well.
//   move(dt, velocity)       y <- y + dt f(y'), positions with the velocity that `velocity` names.

// The last evaluation of a step is at its middle, ahead = dt/2: that is where powers are measured.

#include "sph/numerics.hpp"

namespace talus {

/// The velocity that moves the positions over a step.
enum class PositionVelocity {
  midpoint,  ///< that of the last evaluation, in the middle of the step
  mean,      ///< the mean of those at the start and at the end
};

/// Midpoint Runge-Kutta of second order, as in [Z20] 2.1: two evaluations.
///   y' = y + dt/2 f(y);  y <- y + dt f(y')
template <class BackEnd>
auto step_rk2(BackEnd& y, double dt) {
  y.evaluate(0.0, true);
  y.evaluate(0.5 * dt, false);
  return y.move(dt, PositionVelocity::midpoint);
}

/// Leapfrog in its drift-kick-drift form: one evaluation. Velocities, densities and stresses are predicted to the
/// middle of the step with the rates of the step before, so that forces that depend on them stay second order.
///   x' = x + dt/2 v;  v <- v + dt a(x', v');  x <- x' + dt/2 v
template <class BackEnd>
auto step_leapfrog(BackEnd& y, double dt) {
  y.evaluate(0.5 * dt, true);
  return y.move(dt, PositionVelocity::mean);
}

/// One step of dt [s] by the chosen integrator.
template <class BackEnd>
auto advance(Integrator integrator, BackEnd& y, double dt) {
  return integrator == Integrator::rk2 ? step_rk2(y, dt) : step_leapfrog(y, dt);
}

/// Evaluations of the right-hand side in one step.
constexpr int evaluations_per_step(Integrator integrator) { return integrator == Integrator::rk2 ? 2 : 1; }

}  // namespace talus

#include "integrate/integrator.hpp"

namespace talus {

void StepStart::save(const Soil& soil) {
  x = soil.x, y = soil.y, vx = soil.vx, vy = soil.vy, rho = soil.rho, txx = soil.txx, tyy = soil.tyy, txy = soil.txy;
}

namespace {

/// What both integrators do with the quantities that are not positions: y <- start + dt rate.
void move_from(Soil& s, const StepStart& start, std::size_t i, double dt) {
  s.vx[i] = start.vx[i] + dt * s.ax[i];
  s.vy[i] = start.vy[i] + dt * s.ay[i];
  s.rho[i] = start.rho[i] + dt * s.drho[i];
  s.txx[i] = start.txx[i] + dt * s.dtxx[i];
  s.tyy[i] = start.tyy[i] + dt * s.dtyy[i];
  s.txy[i] = start.txy[i] + dt * s.dtxy[i];
}

}  // namespace

void step_rk2(Soil& soil, StepStart& start, double dt, const Evaluate& evaluate) {
  evaluate(soil);
  start.save(soil);  // after the evaluation, which returns the elastic stress to the yield surface
  const auto n = soil.n_active;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    soil.x[i] = start.x[i] + 0.5 * dt * start.vx[i];
    soil.y[i] = start.y[i] + 0.5 * dt * start.vy[i];
    move_from(soil, start, i, 0.5 * dt);
  }
  evaluate(soil);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    soil.x[i] = start.x[i] + dt * soil.vx[i];  // the velocity of the middle
    soil.y[i] = start.y[i] + dt * soil.vy[i];
    move_from(soil, start, i, dt);
  }
}

void step_leapfrog(Soil& soil, StepStart& start, double dt, const Evaluate& evaluate) {
  start.save(soil);
  const auto n = soil.n_active;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    soil.x[i] += 0.5 * dt * soil.vx[i];
    soil.y[i] += 0.5 * dt * soil.vy[i];
    move_from(soil, start, i, 0.5 * dt);
    start.txx[i] -= soil.txx[i], start.tyy[i] -= soil.tyy[i], start.txy[i] -= soil.txy[i];
  }
  evaluate(soil);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    // What the evaluation took off the stress in the middle, to return it to the yield surface, is off the start as
    // well.
    start.txx[i] += soil.txx[i], start.tyy[i] += soil.tyy[i], start.txy[i] += soil.txy[i];
    move_from(soil, start, i, dt);
    soil.x[i] += 0.5 * dt * soil.vx[i];
    soil.y[i] += 0.5 * dt * soil.vy[i];
  }
}

}  // namespace talus

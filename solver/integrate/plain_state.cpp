#include "integrate/plain_state.hpp"

namespace talus {
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

/// start.t += sign * soil.t, for every particle.
void add_stress(StepStart& start, const Soil& soil, double sign) {
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    start.txx[i] += sign * soil.txx[i];
    start.tyy[i] += sign * soil.tyy[i];
    start.txy[i] += sign * soil.txy[i];
  }
}

}  // namespace

void StepStart::save(const Soil& soil) {
  x = soil.x;
  y = soil.y;
  vx = soil.vx;
  vy = soil.vy;
  rho = soil.rho;
  txx = soil.txx;
  tyy = soil.tyy;
  txy = soil.txy;
}

void PlainState::predict(double ahead) {
  start_.save(soil_);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    soil_.x[i] += ahead * soil_.vx[i];
    soil_.y[i] += ahead * soil_.vy[i];
    move_from(soil_, start_, i, ahead);
  }
}

void PlainState::evaluate(double ahead, bool commit) {
  if (ahead == 0.0) {
    evaluate_(soil_);  // returns the stress of the state itself to the yield surface
    return;
  }
  predict(ahead);
  if (commit) add_stress(start_, soil_, -1.0);
  evaluate_(soil_);
  if (commit) add_stress(start_, soil_, 1.0);
}

void PlainState::move(double dt, PositionVelocity velocity) {
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    if (velocity == PositionVelocity::midpoint) {
      soil_.x[i] = start_.x[i] + dt * soil_.vx[i];
      soil_.y[i] = start_.y[i] + dt * soil_.vy[i];
      move_from(soil_, start_, i, dt);
    } else {  // the positions are in the middle already, moved by the velocity at the start
      move_from(soil_, start_, i, dt);
      soil_.x[i] += 0.5 * dt * soil_.vx[i];
      soil_.y[i] += 0.5 * dt * soil_.vy[i];
    }
  }
}

}  // namespace talus

#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "integrate/schemes.hpp"
#include "simulation/observables.hpp"
#include "simulation/pore_pressure.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Beyond an open end of the bed, or over the wall of a walled one.
bool departed(const Terrain& terrain, Vec2 x) {
  if (x.x < terrain.bed.front().x) return !terrain.left_wall || x.y > terrain.left_wall_top();
  if (x.x > terrain.bed.back().x) return !terrain.right_wall || x.y > terrain.right_wall_top();
  return false;
}

constexpr std::int64_t observation_interval = 20;  ///< steps between two observations of rest and density
constexpr std::int64_t thickness_interval = 100;   ///< the same of the thickness, which takes longer

/// Pore pressure ratios by id, where softened friction depends on them.
std::vector<double> ratios_for_softening(const Model& model, const ParticlePlan& plan) {
  const bool softens =
      std::ranges::any_of(model.materials, [](const Material& m) { return m.softening && m.softening->phi; });
  return softens && has_pore_pressure(model) ? pore_pressure_ratios(model, plan.soil) : std::vector<double>{};
}

/// Adds up the times of parts of a run.
StageTimes operator+(const StageTimes& a, const StageTimes& b) {
  return {a.sort + b.sort,   a.lists + b.lists,       a.gradient + b.gradient,
          a.walls + b.walls, a.momentum + b.momentum, a.update + b.update};
}

}  // namespace

Simulation::Simulation(const Model& model, const ParticlePlan& plan, const SoilProperties& properties)
    : model_(model),
      soil_(make_soil(model, flow_constants(model), plan, properties)),
      walls_(make_walls(plan.walls, model.dx, model.boundaries)),
      flow_(make_flow(flow_constants(model), soil_)),
      neighbours_(walls_, constants().h, model.dx),
      starts_(plan.soil, bounding_box(model.slide)),
      contact_(wall_lines(model.boundaries, model.dx, model.placement), wall_friction(model.boundaries), model.dx,
               model.g, plan.soil.size(), model.boundaries),
      drag_(constants(), walls_),
      strength_loss_(model, constants(), soil_, ratios_for_softening(model, plan)),
      energy_account_(constants(), soil_),
      gauges_(model.targets, model.terrain.run_out.to, model.dx),
      rest_rule_(model.time.stop_at_rest),
      bounds_(step_bounds(model, constants(), soil_)),
      max_acceleration_(norm(model.g)) {
  flow_->observe_loads(gauges_.structures());
  contact_.observe_loads(gauges_.structures());
}

void Simulation::step(double until) {
  const double dt = choose_step(until);
  neighbours_.prepare(soil_, walls_, *flow_, dt, max_speed_);
  filter_density_if_due();
  lose_strength(dt);
  drag_along_the_bed();
  StepExtrema extrema = flow_step(dt);

  Stopwatch watch;
  time_ = until - time_ <= dt ? until : time_ + dt;
  ++steps_;
  evaluations_ += evaluations_per_step(model_.numerics.integrator);
  check(extrema);
  meet_the_ground(extrema);
  add_loads(dt);
  max_speed_ = extrema.max_speed;
  max_acceleration_ = extrema.max_acceleration;
  peak_speed_ = std::max(peak_speed_, max_speed_);
  neighbours_.advance(extrema);
  if (steps_ % observation_interval == 0) {
    if (rest_rule_.active()) rest_rule_.observe(time_, rms_speed(soil_));
    peak_density_rise_ = std::max(peak_density_rise_, density_rise());
    gauges_.observe(soil_, model_.materials, time_);
  }
  if (steps_ % thickness_interval == 0) flow_thickness_.observe(soil_, model_.materials, model_.dx, time_);
  retire_departed(extrema);
  watch.lap(times_.update);
}

/// The flow of one step, whose powers are measured when they are due.
StepExtrema Simulation::flow_step(double dt) {
  if (!energy_account_.due(steps_)) return flow_->step(soil_, walls_, neighbours_.cells(), dt);
  Powers powers;
  const StepExtrema extrema = flow_->step(soil_, walls_, neighbours_.cells(), dt, &powers);
  energy_account_.measure(powers, time_ + 0.5 * dt);
  return extrema;
}

double Simulation::choose_step(double until) const {
  const double dt = time_step(model_.time, bounds_, max_speed_, max_acceleration_);
  // A remainder shorter than a thousandth of a step is added to this one, so that rounding leaves no tiny last step.
  const double remainder = until - time_;
  return remainder < 1.001 * dt ? remainder : dt;
}

void Simulation::filter_density_if_due() {
  const Numerics& numerics = model_.numerics;
  if (numerics.density_filter != DensityFilter::shepard || steps_ == 0 || steps_ % numerics.filter_interval != 0)
    return;
  Stopwatch watch;
  const double before = compression_energy(constants(), soil_);
  flow_->filter_density(soil_, walls_, neighbours_.cells());
  energy_account_.filtered(before - compression_energy(constants(), soil_));
  watch.lap(times_.update);
}

/// The first evaluation of the step returns the elastic stress to the yield surface.
void Simulation::lose_strength(double dt) {
  if (!strength_loss_.active()) return;
  Stopwatch watch;
  const double ahead = model_.numerics.integrator == Integrator::leapfrog ? 0.5 * dt : 0.0;
  if (strength_loss_.act(*flow_, soil_, ahead, steps_)) flow_->strength_changed(soil_);
  watch.lap(times_.update);
}

void Simulation::drag_along_the_bed() {
  if (!drag_.active()) return;
  Stopwatch watch;
  drag_.act(soil_, walls_);
  flow_->drag_changed(walls_);
  watch.lap(times_.update);
}

/// Is every particle finite, and slower than ten times the fastest wave?
void Simulation::check(const StepExtrema& extrema) const {
  if (!extrema.all_finite || !(extrema.max_speed < 10.0 * bounds_.c)) report_divergence();
}

void Simulation::report_divergence() const {
  const double fastest2 = 100.0 * bounds_.c * bounds_.c;
  std::int32_t first = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    const bool plausible = std::isfinite(norm2(soil_.position(i)) + soil_.rho[i]) && soil_.rho[i] > 0.0 &&
                           norm2(soil_.velocity(i)) < fastest2;
    if (!plausible) first = std::min(first, soil_.id[i]);
  }
  const Vec2 start = starts_[first] + model_.terrain.origin;
  throw DivergedError("the run diverged at step " + std::to_string(steps_) + ", time " + std::to_string(time_) +
                          " s: particle " + std::to_string(first) + ", which started at (" + std::to_string(start.x) +
                          ", " + std::to_string(start.y) + ") m, is no longer finite or faster than 10 times sound",
                      steps_, time_, first);
}

/// Single particles meet the ground; what they are put back counts as moved.
void Simulation::meet_the_ground(StepExtrema& extrema) {
  const double put_back = contact_.act(soil_, extrema.max_displacement);
  if (put_back == 0.0) return;
  extrema.max_displacement += put_back;
  extrema.moved_since_sort += put_back;
  flow_->state_changed();
}

/// What pressed on the structures in the step, and what single particles that hit them lost.
void Simulation::add_loads(double dt) {
  if (flow_->loads().empty()) return;
  std::vector<WallLoad> loads = flow_->loads();
  for (std::size_t s = 0; s < contact_.impulses().size(); ++s) loads[s] += (1.0 / dt) * contact_.impulses()[s];
  gauges_.add_loads(loads, dt, time_);
}

/// Soil that left the terrain stops taking part: it is swapped behind the active ones and keeps its last state.
void Simulation::retire_departed(const StepExtrema& extrema) {
  if (model_.terrain.closed) return;
  const Terrain& terrain = model_.terrain;
  if (extrema.leftmost >= terrain.bed.front().x && extrema.rightmost <= terrain.bed.back().x) return;
  for (std::size_t i = 0; i < soil_.n_active;) {
    if (!departed(terrain, soil_.position(i))) {
      ++i;
      continue;
    }
    const std::size_t last = --soil_.n_active;
    for_each_state(soil_, [&](const char*, auto& array) { std::swap(array[i], array[last]); });
    std::swap(soil_.material[i], soil_.material[last]);
    std::swap(soil_.id[i], soil_.id[last]);
    flow_->swap_rates(soil_, i, last);
    neighbours_.require_sort();
  }
}

StageTimes Simulation::times() const { return times_ + neighbours_.times() + flow_->times(); }

}  // namespace talus

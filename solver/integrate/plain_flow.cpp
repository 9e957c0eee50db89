#include "integrate/plain_flow.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// The extrema that the vectorised loops find on their way.
StepExtrema find_extrema(const Soil& soil, const Soil& start) {
  StepExtrema e;
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    const Vec2 sorted{static_cast<double>(soil.x_sorted[i]), static_cast<double>(soil.y_sorted[i])};
    const bool finite = std::isfinite(norm2(soil.position(i)) + norm2(soil.velocity(i)) + soil.rho[i]);
    const double displacement = norm(soil.position(i) - Vec2{start.x[i], start.y[i]});
    e = e.merge({displacement, norm({soil.ax[i], soil.ay[i]}), norm(soil.velocity(i)), norm(soil.position(i) - sorted),
                 soil.x[i], soil.x[i], finite && soil.rho[i] > 0.0});
  }
  return e;
}

void copy_evaluation(const Soil& from, Soil& to) {
  std::vector<const std::vector<double>*> sources;
  const auto collect = [&](const char*, const std::vector<double>& array) { sources.push_back(&array); };
  for_each_rate(from, collect);
  for_each_derived(from, collect);
  auto source = sources.begin();
  const auto copy = [&](const char*, std::vector<double>& array) { array = **source++; };
  for_each_rate(to, copy);
  for_each_derived(to, copy);
}

/// What moves with a rate of its own, besides the positions.
constexpr struct {
  std::vector<double> Soil::*value, Soil::*rate;
} moved[] = {{&Soil::vx, &Soil::ax},    {&Soil::vy, &Soil::ay},    {&Soil::rho, &Soil::drho},
             {&Soil::txx, &Soil::dtxx}, {&Soil::tyy, &Soil::dtyy}, {&Soil::txy, &Soil::dtxy}};

/// y <- start + dt rate
void move_from(Soil& soil, const Soil& start, std::size_t i, double dt) {
  for (const auto& [value, rate] : moved) (soil.*value)[i] = (start.*value)[i] + dt * (soil.*rate)[i];
}

/// start.t += sign * soil.t, for every particle.
void add_stress(Soil& start, const Soil& soil, double sign) {
  for (const auto t : {&Soil::txx, &Soil::tyy, &Soil::txy})
    for (std::size_t i = 0; i < soil.n_active; ++i) (start.*t)[i] += sign * (soil.*t)[i];
}

}  // namespace

void PlainState::evaluate(double ahead, bool commit) {
  if (ahead == 0.0) {
    evaluate_(soil_);  // returns the stress of the state itself to the yield surface
    return;
  }
  start_ = soil_;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    soil_.x[i] += ahead * soil_.vx[i];
    soil_.y[i] += ahead * soil_.vy[i];
    move_from(soil_, start_, i, ahead);
  }
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

PlainFlow::PlainFlow(FlowConstants constants, Soil& soil) : Flow(std::move(constants)) {
  const auto make = [&](const char*, auto& array) { array.assign(soil.size(), 0.0); };
  for_each_rate(soil, make);
  for_each_derived(soil, make);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    soil.p[i] = initial_pressure(this->constants(), soil, i);
    soil.sxx[i] = -soil.p[i];
    soil.syy[i] = -soil.p[i];
  }
}

StepExtrema PlainFlow::step(Soil& soil, WallParticles& walls, const ParticleCells& cells, double dt, Powers* powers) {
  Stopwatch watch;
  double evaluating = 0.0;
  int left = evaluations_per_step(constants().numerics.integrator);
  const Evaluate evaluate = [&](Soil& s) {
    watch.lap(times_.update);
    evaluate_plain(constants(), s, walls, cells, --left == 0 && powers ? &powers_ : nullptr);
    for (std::size_t b = 0; left == 0 && b < loaded_.size(); ++b)
      loads_[b] = load_on(constants(), s, walls, cells, loaded_[b]);
    watch.lap(evaluating);
  };
  PlainState state(soil, start_, evaluate);
  advance(constants().numerics.integrator, state, dt);
  const StepExtrema extrema = find_extrema(soil, start_);
  watch.lap(times_.update);
  times_.gradient += evaluating;
  if (powers) *powers = powers_.total(soil.n_active);
  return extrema;
}

void PlainFlow::permute_rates(Soil& soil, std::span<const std::uint32_t> order, std::vector<double>& scratch) {
  for_each_rate(soil, [&](const char*, auto& array) { permute(array, order, scratch); });
}

void PlainFlow::swap_rates(Soil& soil, std::size_t i, std::size_t j) {
  const auto exchange = [&](const char*, auto& array) { std::swap(array[i], array[j]); };
  for_each_rate(soil, exchange);
  for_each_derived(soil, exchange);
}

void PlainFlow::read_evaluation(const Soil& soil, Soil& to) const { copy_evaluation(soil, to); }
void PlainFlow::write_evaluation(Soil& soil, const Soil& from) { copy_evaluation(from, soil); }

}  // namespace talus

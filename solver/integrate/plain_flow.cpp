#include "integrate/plain_flow.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// The extrema that the vectorised loops find on their way.
StepExtrema find_extrema(const Soil& soil, const StepStart& start) {
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

}  // namespace

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

StepExtrema PlainFlow::step(Soil& soil, WallParticles& walls, const ParticleCells& cells, double dt) {
  Stopwatch watch;
  double evaluating = 0.0;
  const Evaluate evaluate = [&](Soil& s) {
    watch.lap(times_.update);
    rhs_.evaluate(s, walls, cells.soil, cells.walls);
    watch.lap(evaluating);
  };
  PlainState state(soil, start_, evaluate);
  advance(constants().numerics.integrator, state, dt);
  const StepExtrema extrema = find_extrema(soil, start_);
  watch.lap(times_.update);
  times_.gradient += evaluating;
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

#include "simulation/target_gauges.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

TargetGauges::TargetGauges(std::vector<Target> targets, SlidesTo to, double dx)
    : targets_(std::move(targets)), sign_(to == SlidesTo::right ? 1.0 : -1.0), dx_(dx), memory_(targets_.size()) {
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    if (!targets_[k].structure) continue;
    structures_.push_back({targets_[k].structure->boundary, targets_[k].structure->foot});
    target_of_structure_.push_back(k);
  }
}

void TargetGauges::observe(const Soil& soil, std::span<const Material> materials, double time) {
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const TargetFlow now = flow_at(targets_[k], soil, materials, dx_);
    Memory& memory = memory_[k];
    memory.peak = {std::max(memory.peak.depth, now.depth), std::max(memory.peak.speed, now.speed),
                   std::max(memory.peak.dynamic_pressure, now.dynamic_pressure)};
    if (std::isnan(memory.arrival) && now.depth >= targets_[k].threshold) memory.arrival = time;
  }
}

void TargetGauges::add_loads(std::span<const WallLoad> loads, double dt, double time) {
  for (std::size_t s = 0; s < loads.size(); ++s) {
    Memory& memory = memory_[target_of_structure_[s]];
    memory.impulse += dt * loads[s];
    memory.in_window += dt * loads[s];
    const double length = time - memory.window_start;
    if (length < targets_[target_of_structure_[s]].structure->averaging) continue;
    memory.mean = (1.0 / length) * memory.in_window;
    memory.peak_horizontal = std::max(memory.peak_horizontal, sign_ * memory.mean.force.x);
    memory.peak_downward = std::max(memory.peak_downward, -memory.mean.force.y);
    memory.peak_moment = std::max(memory.peak_moment, -sign_ * memory.mean.moment);
    memory.in_window = {};
    memory.window_start = time;
  }
}

std::vector<TargetRow> TargetGauges::rows(const Soil& soil, std::span<const Material> materials, double time,
                                          std::int64_t step) const {
  std::vector<TargetRow> rows;
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const WallLoad& all = memory_[k].impulse;
    rows.push_back({time,
                    step,
                    k,
                    flow_at(targets_[k], soil, materials, dx_),
                    {{sign_ * all.force.x, -all.force.y}, -sign_ * all.moment}});
  }
  return rows;
}

std::vector<TargetOutcome> TargetGauges::outcomes(const Soil& soil, std::span<const Material> materials,
                                                  const RunOutAxis& axis, bool rests, double rest_speed,
                                                  double reachable) const {
  std::vector<TargetOutcome> outcomes;
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Target& target = targets_[k];
    const Memory& memory = memory_[k];
    const TargetFlow now = flow_at(target, soil, materials, dx_);
    TargetOutcome& outcome = outcomes.emplace_back(TargetOutcome{.of = target.of});
    outcome.arrives = !std::isnan(memory.arrival);
    const double nearest = std::min(axis.distance(target.from), axis.distance(target.to));
    outcome.open = !rests && (outcome.arrives ? now.speed > rest_speed : nearest <= reachable);
    outcome.arrival = memory.arrival;
    outcome.peak_depth = memory.peak.depth;
    outcome.peak_speed = memory.peak.speed;
    outcome.peak_dynamic_pressure = memory.peak.dynamic_pressure;
    outcome.final_depth = now.depth;
    if (!target.structure) continue;
    outcome.peak_horizontal_force = memory.peak_horizontal;
    outcome.peak_downward_force = memory.peak_downward;
    outcome.peak_overturning_moment = memory.peak_moment;
    outcome.final_horizontal_force = sign_ * memory.mean.force.x;
    outcome.horizontal_impulse = sign_ * memory.impulse.force.x;
    outcome.downward_impulse = -memory.impulse.force.y;
  }
  return outcomes;
}

template <class AnyMemory, class Use>
void TargetGauges::for_each_number(AnyMemory& memory, const Use& use) {
  for (auto* load : {&memory.impulse, &memory.in_window, &memory.mean}) {
    use(load->force.x);
    use(load->force.y);
    use(load->moment);
  }
  for (auto* number : {&memory.arrival, &memory.peak.depth, &memory.peak.speed, &memory.peak.dynamic_pressure,
                       &memory.window_start, &memory.peak_horizontal, &memory.peak_downward, &memory.peak_moment})
    use(*number);
}

std::vector<double> TargetGauges::state() const {
  std::vector<double> state;
  for (const Memory& memory : memory_) for_each_number(memory, [&](double number) { state.push_back(number); });
  return state;
}

void TargetGauges::restore(const std::vector<double>& state) {
  auto next = state.begin();
  for (Memory& memory : memory_) for_each_number(memory, [&](double& number) { number = *next++; });
}

}  // namespace talus

#include "simulation/checkpoint_state.hpp"

#include <string>

#include "simulation/simulation.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Optional lengths and times are stored as numbers; those that are unset as a negative one.
double stored(std::optional<double> value) { return value.value_or(-1.0); }
std::optional<double> restored(double value) { return value < 0.0 ? std::nullopt : std::optional(value); }

[[noreturn]] void refuse(const std::string& why) {
  throw IoError("the checkpoint does not belong to this case: " + why);
}

/// The array of that name. @throws IoError unless it has n values
template <class T>
const std::vector<T>& array_of(const std::map<std::string, std::vector<T>>& arrays, const std::string& name,
                               std::size_t n) {
  const auto found = arrays.find(name);
  if (found == arrays.end() || found->second.size() != n) refuse("'" + name + "' differs");
  return found->second;
}

}  // namespace

CheckpointState Simulation::state() const {
  CheckpointState s;
  const auto save = [&](const char* name, const auto& array) { s.reals[name].assign(array.begin(), array.end()); };
  Soil evaluated;
  flow_->read_evaluation(soil_, evaluated);
  for_each_state(soil_, save);
  for_each_rate(evaluated, save);
  for_each_derived(evaluated, save);
  save("x_sorted", soil_.x_sorted);
  save("y_sorted", soil_.y_sorted);
  for_each_wall_real(walls_, save);
  s.reals["scalars"] = {time_,
                        peak_speed_,
                        max_speed_,
                        max_acceleration_,
                        stored(rest_rule_.slow_since()),
                        stored(neighbours_.moved_since_sort()),
                        peak_density_rise_};
  s.reals["energy"] = energy_account_.state();
  s.reals["energy"].push_back(contact_.taken());
  const auto thickness = flow_thickness_.state();
  s.reals["flow_thickness"].assign(thickness.begin(), thickness.end());
  if (strength_loss_.active()) {
    save("plastic_strain", strength_loss_.strain());
    save("plastic_strain_pending", strength_loss_.pending());
  }
  if (!model_.targets.empty()) s.reals["targets"] = gauges_.state();
  s.integers["material"].assign(soil_.material.begin(), soil_.material.end());
  s.integers["id"].assign(soil_.id.begin(), soil_.id.end());
  s.integers["penetrated"].assign(contact_.lost_ids().begin(), contact_.lost_ids().end());
  s.integers["counters"] = {static_cast<std::int64_t>(soil_.n_active), steps_, evaluations_};
  return s;
}

void Simulation::restore(const CheckpointState& state) {
  const auto n = soil_.size();
  const auto load = [&](const char* name, auto& array) {
    const auto& saved = array_of(state.reals, name, n);
    array.assign(saved.begin(), saved.end());
  };
  Soil evaluated;
  for_each_state(soil_, load);
  for_each_rate(evaluated, load);
  for_each_derived(evaluated, load);
  load("x_sorted", soil_.x_sorted);
  load("y_sorted", soil_.y_sorted);
  flow_->write_evaluation(soil_, evaluated);
  for_each_wall_real(walls_, [&](const char* name, auto& array) { array = array_of(state.reals, name, array.size()); });

  const auto& material = array_of(state.integers, "material", n);
  const auto& id = array_of(state.integers, "id", n);
  for (std::size_t i = 0; i < n; ++i) {
    if (id[i] < 0 || id[i] >= static_cast<std::int64_t>(n) || material[i] < 0 ||
        material[i] >= static_cast<std::int64_t>(model_.materials.size()))
      refuse("identities out of range");
    soil_.material[i] = static_cast<std::int32_t>(material[i]);
    soil_.id[i] = static_cast<std::int32_t>(id[i]);
  }
  const auto& penetrated = array_of(state.integers, "penetrated", n);
  std::vector<double> energy = array_of(state.reals, "energy", energy_account_.state().size() + 1);
  contact_.restore({penetrated.begin(), penetrated.end()}, energy.back());
  energy.pop_back();
  energy_account_.restore(energy);

  const auto& thickness = array_of(state.reals, "flow_thickness", 3);
  flow_thickness_.restore({thickness[0], thickness[1], thickness[2]});

  if (strength_loss_.active())
    strength_loss_.restore(array_of(state.reals, "plastic_strain", n),
                           array_of(state.reals, "plastic_strain_pending", n));
  if (!model_.targets.empty()) gauges_.restore(array_of(state.reals, "targets", gauges_.state().size()));

  const auto& counters = array_of(state.integers, "counters", 3);
  if (counters[0] < 0 || counters[0] > static_cast<std::int64_t>(n)) refuse("more active particles than there are");
  soil_.n_active = static_cast<std::size_t>(counters[0]);
  steps_ = counters[1];
  evaluations_ = counters[2];

  const auto& scalars = array_of(state.reals, "scalars", 7);
  time_ = scalars[0];
  peak_speed_ = scalars[1];
  max_speed_ = scalars[2];
  max_acceleration_ = scalars[3];
  rest_rule_.restore(restored(scalars[4]));
  peak_density_rise_ = scalars[6];
  neighbours_.restore(restored(scalars[5]), soil_, walls_, *flow_);
}

}  // namespace talus

// What a simulation shows of itself: frames, rows of the history, the result.

#include <algorithm>
#include <cmath>

#include "simulation/observables.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

/// Stress of plane strain as in Frame::stress: tr sigma = -3 p.
std::array<double, 4> stress_components(Sym2 s, double p) { return {s.xx, s.yy, -3.0 * p - s.xx - s.yy, s.xy}; }

}  // namespace

Frame Simulation::frame() const {
  Frame f;
  f.time = time_;
  f.step = steps_;
  f.n_soil = soil_.size();
  const std::size_t n = soil_.size() + walls_.size();
  for (auto* array : {&f.position, &f.displacement, &f.velocity}) array->resize(n);
  for (auto* array : {&f.density, &f.pressure, &f.tan_phi, &f.shear_rate}) array->resize(n);
  f.stress.resize(n);
  Soil evaluated;
  flow_->read_evaluation(soil_, evaluated);
  for (std::size_t i = 0; i < soil_.size(); ++i) {
    const auto k = static_cast<std::size_t>(soil_.id[i]);
    f.position[k] = soil_.position(i);
    f.displacement[k] = soil_.position(i) - starts_[soil_.id[i]];
    f.velocity[k] = soil_.velocity(i);
    f.density[k] = soil_.rho[i];
    f.pressure[k] = evaluated.p[i];
    f.tan_phi[k] = soil_.tan_phi[i];
    f.shear_rate[k] = evaluated.gamma_dot[i];
    f.stress[k] = stress_components(evaluated.stress(i), evaluated.p[i]);
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const std::size_t k = soil_.size() + w;
    f.position[k] = walls_.position(w);
    f.density[k] = model_.materials.front().rho0 * std::max(1.0, walls_.density_ratio[w]);
    f.pressure[k] = walls_.p[w];
    f.stress[k] = stress_components(walls_.stress(w), walls_.p[w]);
  }
  return f;
}

HistoryRow Simulation::history_row() const {
  const double left = model_.terrain.left_boundary;
  return {time_,      steps_,  farthest(soil_) - left, centre_of_mass(soil_).x - left, kinetic_energy(soil_),
          max_speed_, energy()};
}

EnergyBudget Simulation::energy() const {
  return energy_account_.budget(constants(), soil_, starts_, time_, contact_.taken());
}

RunResult Simulation::result() const {
  RunResult r;
  r.measures = measure_fronts(soil_, model_.terrain.left_boundary, model_.dx);
  r.ending = time_ >= model_.time.end ? Ending::end_time : rests() ? Ending::at_rest : Ending::interrupted;
  r.soil = static_cast<std::int64_t>(soil_.size());
  r.wall = static_cast<std::int64_t>(walls_.size());
  r.steps = steps_;
  r.time = time_;
  r.evaluations = evaluations_;
  r.max_speed = peak_speed_;
  r.final_max_speed = max_speed_;
  r.penetrated = contact_.lost();
  r.left_domain = static_cast<std::int64_t>(soil_.size() - soil_.n_active);
  r.at_rest = max_speed_ < 0.01 * std::sqrt(norm(model_.g) * fall_height(model_));
  r.digest = digest(soil_);
  r.backend = backend();
  r.simd = simd();
  r.energy = energy();
  return r;
}

}  // namespace talus

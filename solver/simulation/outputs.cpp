// What a simulation shows of itself: frames, rows of the history, the result.

#include <algorithm>
#include <cmath>

#include "simulation/observables.hpp"
#include "simulation/reach.hpp"
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
  f.origin = model_.terrain.origin;
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
  add_varying_properties(f);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const std::size_t k = soil_.size() + w;
    f.position[k] = walls_.position(w);
    f.density[k] = model_.materials.front().rho0 * std::max(1.0, walls_.density_ratio[w]);
    f.pressure[k] = walls_.p[w];
    f.stress[k] = stress_components(walls_.stress(w), walls_.p[w]);
  }
  return f;
}

/// Cohesion and viscosity where they differ from the materials', or will: softening soil has its own from the start.
void Simulation::add_varying_properties(Frame& f) const {
  const std::size_t n = f.position.size();
  const auto of_material = [&](std::size_t i) {
    return model_.materials[static_cast<std::size_t>(soil_.material[i])].c == soil_.c[i];
  };
  bool cohesion_varies =
      std::ranges::any_of(model_.materials, [](const Material& m) { return m.softening.has_value(); });
  for (std::size_t i = 0; i < soil_.size() && !cohesion_varies; ++i) cohesion_varies = !of_material(i);
  if (cohesion_varies) f.cohesion.assign(n, 0.0);
  if (!soil_.eta.empty()) f.viscosity.assign(n, 0.0);
  for (std::size_t i = 0; i < soil_.size(); ++i) {
    const auto k = static_cast<std::size_t>(soil_.id[i]);
    if (cohesion_varies) f.cohesion[k] = soil_.c[i];
    if (!soil_.eta.empty()) f.viscosity[k] = soil_.eta[i];
  }
}

HistoryRow Simulation::history_row() const {
  const RunOutAxis& axis = model_.terrain.run_out;
  return {time_,      steps_,  farthest(soil_, axis), axis.distance(centre_of_mass(soil_).x), kinetic_energy(soil_),
          max_speed_, energy()};
}

std::vector<TargetRow> Simulation::target_rows() const { return gauges_.rows(soil_, model_.materials, time_, steps_); }

EnergyBudget Simulation::energy() const {
  return energy_account_.budget(constants(), soil_, starts_, time_, contact_.taken());
}

/// Largest rho/rho0 - 1 now.
double Simulation::density_rise() const {
  double rise = 0.0;
#pragma omp parallel for schedule(static) reduction(max : rise)
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    rise = std::max(rise, soil_.rho[i] / reference_density(constants(), soil_, i) - 1.0);
  }
  return rise;
}

/// By how much the front would still advance, to either side, if every particle slid on flat ground from its present
/// speed: v^2/(2 |g| tan(phi)). Particles without friction are passed over. [m]
double Simulation::run_on() const {
  double left = 1e300, right = -1e300, left_then = 1e300, right_then = -1e300;
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    const Vec2 v = soil_.velocity(i);
    left = std::min(left, soil_.x[i]);
    right = std::max(right, soil_.x[i]);
    if (soil_.tan_phi[i] <= 0.0) continue;
    const double slide = norm2(v) / (2.0 * norm(model_.g) * soil_.tan_phi[i]);
    left_then = std::min(left_then, soil_.x[i] - (v.x < 0.0 ? slide : 0.0));
    right_then = std::max(right_then, soil_.x[i] + (v.x > 0.0 ? slide : 0.0));
  }
  return std::max({0.0, right_then - right, left - left_then});
}

/// By how much the leading tenth of the soil would advance, at its present mean velocity, in as long again as the run
/// has lasted: viscous soil creeps far at a speed that is small. Vibrations cancel. [m]
double Simulation::creep() const {
  const RunOutAxis& axis = model_.terrain.run_out;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < soil_.n_active; ++i) order.emplace_back(-axis.distance(soil_.x[i]), i);
  if (order.empty()) return 0.0;
  std::ranges::sort(order);
  order.resize(std::max<std::size_t>(order.size() / 10, 1));
  double momentum = 0.0, mass = 0.0;
  for (const auto& [place, i] : order) {
    momentum += soil_.m[i] * (axis.to == SlidesTo::right ? soil_.vx[i] : -soil_.vx[i]);
    mass += soil_.m[i];
  }
  return std::max(0.0, momentum / mass * time_);
}

/// Root-mean-square speed over sqrt(|g| H) [-].
double Simulation::relative_speed() const { return rms_speed(soil_) / std::sqrt(norm(model_.g) * fall_height(model_)); }

/// By the rule of the case, or by that of the verdict (`still_moving`, `front_still_moving`, `creeping`).
bool Simulation::at_rest() const {
  return rests() || (relative_speed() <= rest_speed && run_on() <= rest_advance * model_.dx &&
                     creep() <= rest_advance * model_.dx);
}

/// Particles that are within the kernel's reach of an open end of the bed, and did not start there: nothing holds them
/// back from the other side, which draws them on by up to two spacings.
std::int64_t Simulation::at_open_end() const {
  const Terrain& terrain = model_.terrain;
  if (terrain.closed) return 0;
  const double reach = 2.0 * constants().h;
  const double left = terrain.left_wall ? -1e300 : terrain.bed.front().x + reach;
  const double right = terrain.right_wall ? 1e300 : terrain.bed.back().x - reach;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    const bool at_end = soil_.x[i] < left || soil_.x[i] > right;
    if (at_end && norm(soil_.position(i) - starts_[soil_.id[i]]) > model_.dx) ++count;
  }
  return count;
}

/// Outlines of the densities that the particles have: the mean of each material where its density varies.
SlideMass Simulation::mass() const {
  const double filled = total_mass(soil_), outline = mass_of(model_.slide, model_.materials) + model_.left_out;
  if (soil_.rho0.empty()) return {filled, outline};
  double nominal = 0.0;
  for (std::size_t i = 0; i < soil_.size(); ++i)
    nominal += soil_.m[i] / soil_.rho0[i] * model_.materials[static_cast<std::size_t>(soil_.material[i])].rho0;
  return {filled, outline * (filled / nominal)};
}

/// How far the soil went, and how much of it is above the energy line with what it still has of kinetic energy.
void Simulation::add_friction_facts(RunFacts& f) const {
  const double friction = std::min(least_friction(model_), std::ranges::min(soil_.tan_phi));
  if (model_.g.x != 0.0 || friction <= 0.0) return;
  const EnergyLine line = energy_line(model_, friction);
  double mass = 0.0, beyond = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < soil_.size(); ++i) {
    const Vec2 x = soil_.position(i);
    const double head = x.y + norm2(soil_.velocity(i)) / (2.0 * norm(model_.g));
    mass += soil_.m[i];
    moment += soil_.m[i] * std::abs(x.x - starts_[soil_.id[i]].x);
    if (head > line.height(x.x) + model_.dx) beyond += soil_.m[i];
  }
  f.least_friction = friction;
  f.beyond_energy_line = beyond / mass;
  f.travel = moment / mass;
}

/// Soil that slides on friction, or creeps, may still reach what lies no farther ahead of it than that takes it.
std::vector<TargetOutcome> Simulation::target_outcomes() const {
  const double front = farthest(soil_, model_.terrain.run_out);
  return gauges_.outcomes(soil_, model_.materials, model_.terrain.run_out, at_rest(),
                          rest_speed * std::sqrt(norm(model_.g) * fall_height(model_)),
                          front + std::max(run_on(), creep()));
}

RunFacts Simulation::facts() const {
  std::vector<Vec2> starts;
  for (std::size_t id = 0; id < soil_.size(); ++id) starts.push_back(starts_[static_cast<std::int32_t>(id)]);
  RunFacts f = facts_before_run(model_, starts);
  f.weight = total_mass(soil_) * norm(model_.g);
  f.mach = peak_speed_ / constants().c_s;
  f.density_rise = std::max(peak_density_rise_, density_rise());
  f.penetrated = contact_.lost();
  f.left_domain = static_cast<std::int64_t>(soil_.size() - soil_.n_active);
  f.at_open_end = at_open_end();
  f.time = time_;
  f.rms_speed = relative_speed();
  f.run_on = run_on();
  if (*f.rms_speed <= rest_speed) f.creep = creep();
  f.mass_change = mass().filled / mass().outline - 1.0;
  f.flow_rows = flow_thickness_.mean();
  add_friction_facts(f);
  return f;
}

RunResult Simulation::result() const {
  RunResult r;
  r.measures = measure_fronts(soil_, model_.terrain, model_.dx, model_.materials);
  r.front_thickness = model_.terrain.front_thickness;
  r.notes = notes_on(r.measures, r.front_thickness, model_.dx);
  r.lower_bounds = lower_bounds(soil_, model_.terrain, r.measures);
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
  r.at_rest = at_rest();
  r.mass = mass();
  r.digest = digest(soil_);
  r.backend = backend();
  r.simd = simd();
  r.energy = energy();
  r.targets = target_outcomes();
  return r;
}

}  // namespace talus

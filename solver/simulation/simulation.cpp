#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "simulation/observables.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Way that a particle may go before all are sorted again [h]. Without lists of neighbours every search pays for it.
constexpr double skin(bool lists) { return lists ? 0.3 : 0.1; }
constexpr std::int64_t rest_interval = 20;         ///< steps between two looks at the rest rule
constexpr std::int64_t penetration_interval = 50;  ///< steps between two looks behind the walls

FlowConstants flow_constants(const Model& model) {
  const double c_s = sound_speed(model);
  return {model.numerics.h_over_dx * model.dx,
          model.dx,
          c_s,
          model.g,
          model.rheology,
          model.numerics,
          model.walls,
          point_laws(model.materials, model.rheology, c_s)};
}

/// Compression wave of the stiffest material: sqrt(c_s^2 + 4/3 G/rho0) with the elastic law, c_s otherwise.
StepBounds step_bounds(const Model& model, const FlowConstants& k) {
  StepBounds bounds{model.numerics.cfl, k.h, k.c_s, 0.0};
  for (const PointLaw& law : k.laws) {
    if (model.rheology.yield == Yield::elastic)
      bounds.c = std::max(bounds.c, std::sqrt(k.c_s * k.c_s + 4.0 / 3.0 * law.G / law.eos.rho0));
    bounds.nu = std::max(bounds.nu, law.bingham.eta / law.eos.rho0);
  }
  return bounds;
}

Soil make_soil(const Model& model, const FlowConstants& k, const std::vector<SoilPoint>& points,
               const std::vector<double>& tan_phi) {
  Soil soil;
  const auto make = [&](const char*, auto& array) { array.assign(points.size(), 0.0); };
  const bool vectorised = VectorisedFlow::serves(model.numerics);
  for_each_state(soil, make);
  if (!vectorised) for_each_rate(soil, make), for_each_derived(soil, make);
  soil.material.resize(points.size());
  soil.id.resize(points.size());
  soil.n_active = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto material = static_cast<std::size_t>(points[i].material);
    const Material& m = model.materials[material];
    const bool loaded = model.numerics.initial_pressure == InitialPressure::hydrostatic;
    const double p = loaded ? overburden(model.slide, model.materials, points[i].x) * std::abs(model.g.y) : 0.0;
    soil.x[i] = points[i].x.x, soil.y[i] = points[i].x.y;
    soil.rho[i] = k.laws[material].eos.density(p);
    soil.m[i] = m.rho0 * model.dx * model.dx;
    soil.tan_phi[i] = tan_phi.empty() ? std::tan(m.phi) : tan_phi[i];
    if (!vectorised) soil.p[i] = p, soil.sxx[i] = soil.syy[i] = -p;
    soil.material[i] = points[i].material;
    soil.id[i] = static_cast<std::int32_t>(i);
  }
  return soil;
}

WallParticles make_walls(const std::vector<WallPoint>& points, double dx) {
  WallParticles walls;
  walls.volume = dx * dx;
  for (const WallPoint& w : points) {
    walls.x.push_back(w.x.x), walls.y.push_back(w.x.y);
    walls.nx.push_back(w.n.x), walls.ny.push_back(w.n.y);
    walls.depth.push_back(w.depth);
  }
  for_each_wall_real(walls, [&](const char*, auto& array) { array.assign(points.size(), 0.0); });
  return walls;
}

}  // namespace

ParticlePlan plan_particles(const Model& model) {
  double estimate = 0.0;
  for (const SlidePart& part : model.slide) estimate += area(part.outline) / (model.dx * model.dx);
  const Polyline wall = wall_line(model.terrain, model.dx, model.placement);
  const double wall_estimate = model.walls.layers * wall.length() / model.dx;
  if (estimate + wall_estimate > static_cast<double>(model.max_particles))
    throw ConfigError("/particle_spacing_m",
                      "about " + std::to_string(static_cast<std::int64_t>(estimate + wall_estimate)) +
                          " particles, more than the limit of " + std::to_string(model.max_particles) +
                          " (max_particles); use a larger spacing");
  ParticlePlan plan{fill_slide(model.slide, model.terrain, model.dx, model.placement),
                    fill_walls(wall, model.dx, model.walls.layers)};
  if (plan.soil.empty())
    throw ConfigError("/particle_spacing_m", "no soil particle fits into the slide; use a smaller spacing");
  return plan;
}

double fall_height(const Model& model) {
  const Box box = bounding_box(model.slide);
  double lowest = box.lo.y;
  for (const Vec2& v : model.terrain.bed) lowest = std::min(lowest, v.y);
  return box.hi.y - lowest;
}

double sound_speed(const Model& model) {
  return model.numerics.c_s.value_or(10.0 * std::sqrt(2.0 * norm(model.g) * fall_height(model)));
}

double first_step(const Model& model) {
  if (model.time.fixed_step) return *model.time.fixed_step;
  const double dt = courant_step(step_bounds(model, flow_constants(model)), 0.0, norm(model.g));
  return model.time.max_step ? std::min(dt, *model.time.max_step) : dt;
}

Simulation::Simulation(const Model& model, const ParticlePlan& plan, std::vector<double> tan_phi)
    : model_(model),
      wall_line_(wall_line(model.terrain, model.dx, model.placement)),
      rhs_(flow_constants(model)),
      soil_(make_soil(model, rhs_.constants(), plan.soil, tan_phi)),
      walls_(make_walls(plan.walls, model.dx)),
      penetrated_(plan.soil.size(), 0),
      bounds_(step_bounds(model, rhs_.constants())),
      max_acceleration_(norm(model.g)),
      height_(fall_height(model)) {
  const Box box = bounding_box(model.slide);
  origin_box_ = {box.lo, std::max(box.width(), box.height()) / static_cast<double>(1 << 30)};
  origin_.reserve(plan.soil.size());
  for (const SoilPoint& p : plan.soil)
    origin_.push_back({static_cast<std::int32_t>(std::lround((p.x.x - origin_box_.lo.x) / origin_box_.quantum)),
                       static_cast<std::int32_t>(std::lround((p.x.y - origin_box_.lo.y) / origin_box_.quantum))});
  soil_.x_sorted.resize(soil_.size()), soil_.y_sorted.resize(soil_.size());
  if (VectorisedFlow::serves(model.numerics)) fast_.emplace(rhs_.constants(), soil_);
  wall_cells_.build(walls_.x, walls_.y, 2.0 * rhs_.constants().h);
  const auto order = wall_cells_.order();
  for (auto* array : {&walls_.x, &walls_.y, &walls_.nx, &walls_.ny, &walls_.depth}) permute(*array, order, scratch_);
}

double Simulation::choose_step(double until) const {
  double dt = model_.time.fixed_step ? *model_.time.fixed_step : courant_step(bounds_, max_speed_, max_acceleration_);
  if (model_.time.max_step && !model_.time.fixed_step) dt = std::min(dt, *model_.time.max_step);
  // A rest shorter than a thousandth of a step is swallowed, so that rounding leaves no tiny step at the end.
  const double rest = until - time_;
  return rest < 1.001 * dt ? rest : dt;
}

/// Cells over where the particles stood when they were sorted, wide enough for what they may have moved since.
void Simulation::build_cells() {
  const std::size_t n = soil_.n_active;
  const std::span<const float> x(soil_.x_sorted), y(soil_.y_sorted);
  soil_cells_.build(x.first(n), y.first(n), (2.0 + skin(fast_.has_value())) * rhs_.constants().h);
}

void Simulation::sort() {
  const auto round = [](double value) { return static_cast<float>(value); };
  std::ranges::transform(soil_.x, soil_.x_sorted.begin(), round);
  std::ranges::transform(soil_.y, soil_.y_sorted.begin(), round);
  build_cells();
  const auto order = soil_cells_.order();
  const auto apply = [&](const char*, auto& array) { permute(array, order, scratch_); };
  for_each_state(soil_, apply);
  if (fast_)
    fast_->permute(order, scratch_);
  else
    for_each_rate(soil_, apply);
  permute(soil_.x_sorted, order, scratch_), permute(soil_.y_sorted, order, scratch_);
  permute(soil_.material, order, scratch_);
  permute(soil_.id, order, scratch_);
  moved_ = 0.0;
}

/// Lists that last a few steps of dt: a wider way makes them longer, a shorter one makes them often. The best of both
/// grows with the root of a step's way; measured, see solver/sph/README.md.
void Simulation::renew(double dt) {
  if (!fast_) return;
  const double h = rhs_.constants().h, step = dt * max_speed_, widest = skin(true) * h;
  way_ = std::max(std::clamp(0.4 * std::sqrt(model_.dx * step), 0.005 * h, widest), 0.51 * step);
  travelled_ = 0.0;
  fast_->renew(soil_, walls_, soil_cells_, wall_cells_, widest, way_);
}

/// Neighbours are sought from where a particle is in mid-step to where the others stood when they were sorted.
void Simulation::find_neighbours(double dt) {
  const double ahead = 0.5 * dt * max_speed_;
  Stopwatch watch;
  if (moved_ < 0.0 || moved_ + ahead > skin(fast_.has_value()) * rhs_.constants().h) {
    sort();
    watch.lap(times_.sort);
    renew(dt);
  } else if (fast_ && travelled_ + ahead > way_) {
    renew(dt);
  }
  watch.lap(times_.lists);
}

/// Soil that left through an open end stops taking part: it is swapped behind the active ones and keeps its last state.
void Simulation::retire_departed(const Motion& motion) {
  if (model_.terrain.closed) return;
  const double left = model_.terrain.left_wall ? -1e300 : model_.terrain.bed.front().x;
  const double right = model_.terrain.right_wall ? 1e300 : model_.terrain.bed.back().x;
  if (motion.leftmost >= left && motion.rightmost <= right) return;
  for (std::size_t i = 0; i < soil_.n_active;) {
    if (soil_.x[i] >= left && soil_.x[i] <= right) {
      ++i;
      continue;
    }
    const std::size_t last = --soil_.n_active;
    for_each_state(soil_, [&](const char*, auto& array) { std::swap(array[i], array[last]); });
    const auto exchange = [&](const char*, auto& array) { std::swap(array[i], array[last]); };
    if (fast_)
      fast_->swap(i, last);
    else
      for_each_rate(soil_, exchange), for_each_derived(soil_, exchange);
    std::swap(soil_.material[i], soil_.material[last]);
    std::swap(soil_.id[i], soil_.id[last]);
    moved_ = -1.0;
  }
}

void Simulation::step(double until) {
  const double dt = choose_step(until);
  const Numerics& numerics = model_.numerics;
  find_neighbours(dt);
  Stopwatch watch;
  if (numerics.density_filter == DensityFilter::shepard && steps_ > 0 && steps_ % numerics.filter_interval == 0)
    filter_density();
  const bool rk2 = numerics.integrator == Integrator::rk2;
  double evaluating = 0.0;
  Motion motion;
  if (fast_) {
    const double before = fast_->times().total();
    motion = fast_->step(soil_, walls_, dt, rk2);
    evaluating = fast_->times().total() - before;
  } else {
    const Evaluate evaluate = [&](Soil& soil) { rhs_.evaluate(soil, walls_, soil_cells_, wall_cells_); };
    rk2 ? step_rk2(soil_, start_, dt, evaluate) : step_leapfrog(soil_, start_, dt, evaluate);
    motion = plain_motion();
  }
  evaluations_ += rk2 ? 2 : 1;
  ++steps_;
  time_ = until - time_ <= dt ? until : time_ + dt;
  check(motion);
  retire_departed(motion);
  if (steps_ % penetration_interval == 0) count_penetrations();
  watch.lap(times_.update);
  times_.update -= evaluating;
}

StageTimes Simulation::times() const {
  StageTimes t = times_;
  if (!fast_) return t;
  const StageTimes& passes = fast_->times();
  t.update += passes.update, t.gradient += passes.gradient, t.walls += passes.walls, t.momentum += passes.momentum;
  return t;
}

void Simulation::report_divergence(double fastest2) const {
  std::int32_t bad = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    const bool sound = std::isfinite(norm2(soil_.position(i)) + soil_.rho[i]) && soil_.rho[i] > 0.0 &&
                       norm2(soil_.velocity(i)) < fastest2;
    if (!sound) bad = std::min(bad, soil_.id[i]);
  }
  const Vec2 start = origin(bad);
  throw DivergedError("the run diverged at step " + std::to_string(steps_) + ", time " + std::to_string(time_) +
                          " s: particle " + std::to_string(bad) + ", which started at (" + std::to_string(start.x) +
                          ", " + std::to_string(start.y) +
                          ") m, is no longer finite or faster than 10 times sound; try a smaller time step",
                      steps_, time_, bad);
}

/// What the vectorised loops find out on their way; they also know how far a particle went in the step.
Motion Simulation::plain_motion() const {
  Motion m;
  for (std::size_t i = 0; i < soil_.n_active; ++i) {
    const Vec2 sorted{static_cast<double>(soil_.x_sorted[i]), static_cast<double>(soil_.y_sorted[i])};
    m.acceleration = std::max(m.acceleration, norm({soil_.ax[i], soil_.ay[i]}));
    m.speed = std::max(m.speed, norm(soil_.velocity(i))), m.moved = std::max(m.moved, norm(soil_.position(i) - sorted));
    m.leftmost = std::min(m.leftmost, soil_.x[i]), m.rightmost = std::max(m.rightmost, soil_.x[i]);
    m.sound = m.sound && std::isfinite(norm2(soil_.position(i)) + norm2(soil_.velocity(i)) + soil_.rho[i]) &&
              soil_.rho[i] > 0.0;
  }
  return m;
}

void Simulation::filter_density() {
  rhs_.filter_density(soil_, walls_, soil_cells_, wall_cells_);
  if (fast_) fast_->state_changed();
}

/// Finite and plausible? Then the extremes for the next step and the rest rule are brought up to date.
void Simulation::check(const Motion& motion) {
  if (const double fastest = 10.0 * bounds_.c; !motion.sound || !(motion.speed < fastest))
    report_divergence(fastest * fastest);
  max_speed_ = motion.speed, max_acceleration_ = motion.acceleration, moved_ = motion.moved;
  travelled_ += motion.way;
  peak_speed_ = std::max(peak_speed_, max_speed_);
  if (model_.time.stop_at_rest && steps_ % rest_interval == 0) {
    if (rms_speed(soil_) >= model_.time.stop_at_rest->speed)
      slow_since_ = -1.0;
    else if (slow_since_ < 0.0)
      slow_since_ = time_;
  }
}

bool Simulation::rests() const { return slow_since_ >= 0.0 && time_ - slow_since_ >= model_.time.stop_at_rest->hold; }

void Simulation::count_penetrations() {
#pragma omp parallel for schedule(static, 512)
  for (std::size_t i = 0; i < soil_.n_active; ++i)
    if (nearest(wall_line_, soil_.position(i)).distance < 0.0) penetrated_[static_cast<std::size_t>(soil_.id[i])] = 1;
}

RunResult Simulation::result() const {
  RunResult r;
  r.measures = measure_fronts(soil_, model_.terrain.left_boundary, model_.dx);
  r.soil = static_cast<std::int64_t>(soil_.size()), r.wall = static_cast<std::int64_t>(walls_.size());
  r.steps = steps_, r.time = time_, r.evaluations = evaluations_;
  r.max_speed = peak_speed_, r.final_max_speed = max_speed_;
  auto behind = penetrated_;
  for (std::size_t i = 0; i < soil_.n_active; ++i)
    if (nearest(wall_line_, soil_.position(i)).distance < 0.0) behind[static_cast<std::size_t>(soil_.id[i])] = 1;
  r.penetrated = std::accumulate(behind.begin(), behind.end(), std::int64_t{0});
  r.left_domain = static_cast<std::int64_t>(soil_.size() - soil_.n_active);
  r.at_rest = max_speed_ < 0.01 * std::sqrt(norm(model_.g) * height_);
  r.digest = digest(soil_);
  r.ending = time_ >= model_.time.end ? Ending::end_time : rests() ? Ending::at_rest : Ending::interrupted;
  return r;
}

HistoryRow Simulation::history_row() const {
  const double left = model_.terrain.left_boundary;
  return {time_, steps_, farthest(soil_) - left, centre_of_mass(soil_).x - left, kinetic_energy(soil_), max_speed_};
}

Vec2 Simulation::origin(std::int32_t id) const {
  const auto& at = origin_.at(static_cast<std::size_t>(id));
  return origin_box_.lo + origin_box_.quantum * Vec2{static_cast<double>(at[0]), static_cast<double>(at[1])};
}

Frame Simulation::frame() const {
  Frame f;
  f.time = time_, f.step = steps_, f.n_soil = soil_.size();
  const std::size_t n = soil_.size() + walls_.size();
  for (auto* array : {&f.position, &f.displacement, &f.velocity}) array->resize(n);
  for (auto* array : {&f.density, &f.pressure, &f.tan_phi, &f.shear_rate}) array->resize(n);
  f.stress.resize(n);
  Soil unpacked;
  if (fast_) fast_->unpack(unpacked);
  const Soil& derived = fast_ ? unpacked : soil_;
  for (std::size_t i = 0; i < soil_.size(); ++i) {
    const auto k = static_cast<std::size_t>(soil_.id[i]);
    f.position[k] = soil_.position(i), f.displacement[k] = soil_.position(i) - origin(soil_.id[i]),
    f.velocity[k] = soil_.velocity(i);
    f.density[k] = soil_.rho[i], f.pressure[k] = derived.p[i];
    f.tan_phi[k] = soil_.tan_phi[i], f.shear_rate[k] = derived.gamma_dot[i];
    const Sym2 s = derived.stress(i);
    f.stress[k] = {s.xx, s.yy, -3.0 * derived.p[i] - s.xx - s.yy, s.xy};  // tr sigma = -3 p
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const std::size_t k = soil_.size() + w;
    f.position[k] = walls_.position(w),
    f.density[k] = model_.materials.front().rho0 * std::max(1.0, walls_.compression[w]);
    f.pressure[k] = walls_.p[w];
    f.stress[k] = {walls_.sxx[w], walls_.syy[w], -3.0 * walls_.p[w] - walls_.sxx[w] - walls_.syy[w], walls_.sxy[w]};
  }
  return f;
}

State Simulation::state() const {
  State s;
  const auto save = [&](const char* name, const auto& array) { s.reals[name].assign(array.begin(), array.end()); };
  Soil unpacked;
  if (fast_) fast_->unpack(unpacked);
  const Soil& evaluated = fast_ ? unpacked : soil_;
  for_each_state(soil_, save), for_each_rate(evaluated, save), for_each_derived(evaluated, save);
  save("x_sorted", soil_.x_sorted), save("y_sorted", soil_.y_sorted);
  for_each_wall_real(walls_, [&](const char* name, const auto& array) { s.reals[name] = array; });
  s.reals["scalars"] = {time_, peak_speed_, max_speed_, max_acceleration_, slow_since_, moved_};
  s.integers["material"].assign(soil_.material.begin(), soil_.material.end());
  s.integers["id"].assign(soil_.id.begin(), soil_.id.end());
  s.integers["penetrated"].assign(penetrated_.begin(), penetrated_.end());
  s.integers["counters"] = {static_cast<std::int64_t>(soil_.n_active), steps_, evaluations_};
  return s;
}

void Simulation::restore(const State& state) {
  const auto take = [&](const auto& map, const std::string& name, std::size_t n) -> const auto& {
    const auto it = map.find(name);
    if (it == map.end() || it->second.size() != n)
      throw IoError("the checkpoint does not belong to this case: '" + name + "' differs");
    return it->second;
  };
  const auto load = [&](const char* name, auto& array) {
    const auto& saved = take(state.reals, name, soil_.size());
    array.assign(saved.begin(), saved.end());
  };
  Soil unpacked;
  Soil& evaluated = fast_ ? unpacked : soil_;
  for_each_state(soil_, load), for_each_rate(evaluated, load), for_each_derived(evaluated, load);
  load("x_sorted", soil_.x_sorted), load("y_sorted", soil_.y_sorted);
  if (fast_) fast_->pack(unpacked);
  for_each_wall_real(walls_, [&](const char* name, auto& array) { array = take(state.reals, name, array.size()); });
  const auto& scalars = take(state.reals, "scalars", 6);
  time_ = scalars[0], peak_speed_ = scalars[1], max_speed_ = scalars[2], max_acceleration_ = scalars[3],
  slow_since_ = scalars[4];
  moved_ = scalars[5];
  const auto& material = take(state.integers, "material", soil_.size());
  const auto& id = take(state.integers, "id", soil_.size());
  for (std::size_t i = 0; i < soil_.size(); ++i) {
    if (id[i] < 0 || id[i] >= static_cast<std::int64_t>(soil_.size()) || material[i] < 0 ||
        material[i] >= static_cast<std::int64_t>(model_.materials.size()))
      throw IoError("the checkpoint does not belong to this case: identities out of range");
    soil_.material[i] = static_cast<std::int32_t>(material[i]), soil_.id[i] = static_cast<std::int32_t>(id[i]);
  }
  const auto& penetrated = take(state.integers, "penetrated", penetrated_.size());
  penetrated_.assign(penetrated.begin(), penetrated.end());
  const auto& counters = take(state.integers, "counters", 3);
  if (counters[0] < 0 || counters[0] > static_cast<std::int64_t>(soil_.size()))
    throw IoError("the checkpoint does not belong to this case: more active particles than there are");
  soil_.n_active = static_cast<std::size_t>(counters[0]), steps_ = counters[1], evaluations_ = counters[2];
  build_cells();
  renew(0.0);
}

}  // namespace talus

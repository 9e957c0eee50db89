#include "simulation/particle_setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <string>

#include "material/pore_pressure.hpp"
#include "particles/ground.hpp"
#include "simulation/pore_pressure.hpp"
#include "simulation/reach.hpp"
#include "support/error.hpp"

namespace talus {

ParticleEstimate estimate_particles(const Model& model, std::span<const Polyline> walls) {
  ParticleEstimate estimate;
  for (const SlidePart& part : model.slide) estimate.soil_area += area(part.outline);
  for (const Polyline& wall : walls) estimate.row_length += model.walls.layers * wall.length();
  return estimate;
}

namespace {

/// Takes out the particles of a structure that would stand in the ground, or too near to the first row behind its
/// surface: the ground is lined there already.
void remove_founded(std::vector<WallPoint>& points, const Polyline& ground_line, double dx) {
  const Ground ground({ground_line});
  std::erase_if(points, [&](const WallPoint& point) { return ground.nearest(point.x).distance < 0.25 * dx; });
}

}  // namespace

ParticlePlan plan_particles(const Model& model) {
  const std::vector<Polyline> walls = wall_lines(model.boundaries, model.dx, model.placement);
  const double estimate = estimate_particles(model, walls).count(model.dx);
  if (estimate > static_cast<double>(model.max_particles))
    throw ConfigError("/particle_spacing_m", "about " + std::to_string(static_cast<std::int64_t>(estimate)) +
                                                 " particles, more than the limit of " +
                                                 std::to_string(model.max_particles) +
                                                 " (max_particles); use a larger spacing");
  ParticlePlan plan{fill_slide(model.slide, walls, model.dx, model.placement, model.terrain.run_out.to, model.lattice),
                    {}};
  for (std::size_t b = 0; b < walls.size(); ++b) {
    std::vector<WallPoint> points = fill_walls(walls[b], model.dx, model.walls.layers, static_cast<std::int32_t>(b));
    if (b > 0) remove_founded(points, walls.front(), model.dx);
    std::ranges::move(points, std::back_inserter(plan.walls));
  }
  if (plan.soil.empty())
    throw ConfigError("/particle_spacing_m", "no soil particle fits into the slide; use a smaller spacing");
  return plan;
}

double particle_mass(const Model& model, const SoilPoint& point) {
  return model.materials[static_cast<std::size_t>(point.material)].rho0 * model.dx * model.dx * point.cells;
}

double cell_area(const Model& model, const SoilPoint& point) { return model.dx * model.dx * point.cells; }

SlideMass slide_mass(const Model& model, const ParticlePlan& plan) {
  SlideMass mass{0.0, mass_of(model.slide, model.materials) + model.left_out};
  for (const SoilPoint& point : plan.soil) mass.filled += particle_mass(model, point);
  return mass;
}

namespace {

/// c_u = c_u0 + gradient x depth below the ground surface, where the gradient is not 0.
void add_strength_by_depth(const Model& model, const ParticlePlan& plan, std::vector<double>& c) {
  if (std::ranges::none_of(model.materials, [](const Material& m) { return m.c_gradient > 0.0; })) return;
  const std::vector<double> depth = depths(model, plan.soil);
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] += model.materials[static_cast<std::size_t>(plan.soil[i].material)].c_gradient * depth[i];
}

/// Friction as the carried pore pressure leaves it; undrained soil has none.
void apply_water(const Model& model, const ParticlePlan& plan, std::vector<double>& tan_phi) {
  if (has_pore_pressure(model)) {
    const std::vector<double> ratio = pore_pressure_ratios(model, plan.soil);
    for (std::size_t i = 0; i < tan_phi.size(); ++i) tan_phi[i] = total_stress_friction(tan_phi[i], ratio[i]);
  }
  for (std::size_t i = 0; i < tan_phi.size(); ++i)
    if (model.materials[static_cast<std::size_t>(plan.soil[i].material)].undrained) tan_phi[i] = 0.0;
}

}  // namespace

SoilProperties material_properties(const Model& model, const ParticlePlan& plan) {
  SoilProperties properties;
  for (const SoilPoint& point : plan.soil) {
    const Material& material = model.materials[static_cast<std::size_t>(point.material)];
    properties.tan_phi.push_back(std::tan(material.phi));
    properties.c.push_back(material.c);
  }
  add_strength_by_depth(model, plan, properties.c);
  return properties;
}

double sound_speed(const Model& model) {
  return model.numerics.c_s.value_or(10.0 * std::sqrt(2.0 * norm(model.g) * fall_height(model)));
}

FlowConstants flow_constants(const Model& model) {
  const double c_s = sound_speed(model);
  return {model.numerics.h_over_dx * model.dx,
          model.dx,
          c_s,
          model.g,
          model.rheology,
          model.numerics,
          model.walls,
          constitutive_parameters(model.materials, model.rheology, c_s),
          wall_friction(model.boundaries)};
}

namespace {

/// No more than this presses in a run but for moments: the weight of soil as high as the fall, and its impact at the
/// speed of the fall, rho v^2 with v^2 = 2 g H. [Pa]
double largest_pressure(const Model& model, double rho0) { return 3.0 * rho0 * norm(model.g) * fall_height(model); }

/// Widens the bounds by soil of this law, density and viscosity. The stiffness is that of the law: a wave in lighter
/// soil is faster, c^2 = c_s^2 rho0 of the law/rho0.
/// @param p  largest pressure [Pa]
void widen(StepBounds& bounds, const Model& model, const FlowConstants& k, const ConstitutiveParameters& law,
           double rho0, double eta, double p) {
  const bool elastic = keeps_elastic_stress(model.rheology.yield);
  const double c2 = k.c_s * k.c_s * (law.eos.rho0 / rho0);
  if (elastic || rho0 != law.eos.rho0)
    bounds.c = std::max(bounds.c, std::sqrt(c2 + (elastic ? 4.0 / 3.0 * law.G / rho0 : 0.0)));
  bounds.nu = std::max(bounds.nu, (eta + largest_viscosity(law.mu_i, p)) / rho0);
}

/// Mean of rho0/rho0 of the material over each particle and those above it in its column, one spacing wide.
std::vector<double> load_ratios(const Model& model, const std::vector<SoilPoint>& points,
                                const std::vector<double>& rho0) {
  std::vector<double> ratios(points.size(), 1.0);
  if (rho0.empty()) return ratios;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return points[i].x.y; });
  std::map<std::int64_t, Vec2> columns;  ///< area above, and area times ratio
  for (const std::size_t i : order) {
    Vec2& above = columns[static_cast<std::int64_t>(std::floor(points[i].x.x / model.dx))];
    const double of_material = model.materials[static_cast<std::size_t>(points[i].material)].rho0;
    above += points[i].cells * Vec2{1.0, rho0[i] / of_material};
    ratios[i] = above.y / above.x;
  }
  return ratios;
}

}  // namespace

StepBounds step_bounds(const Model& model, const FlowConstants& k) {
  StepBounds bounds{model.numerics.cfl, k.h, k.c_s, 0.0};
  double densest = 0.0;
  for (const ConstitutiveParameters& law : k.soils) densest = std::max(densest, law.eos.rho0);
  for (const ConstitutiveParameters& law : k.soils)
    widen(bounds, model, k, law, law.eos.rho0, law.eta, largest_pressure(model, densest));
  return bounds;
}

StepBounds step_bounds(const Model& model, const FlowConstants& k, const Soil& soil) {
  if (soil.rho0.empty() && soil.eta.empty()) return step_bounds(model, k);
  StepBounds bounds{model.numerics.cfl, k.h, k.c_s, 0.0};
  double densest = 0.0;
  for (std::size_t i = 0; i < soil.size(); ++i) densest = std::max(densest, reference_density(k, soil, i));
  for (std::size_t i = 0; i < soil.size(); ++i)
    widen(bounds, model, k, k.soils[static_cast<std::size_t>(soil.material[i])], reference_density(k, soil, i),
          stated_viscosity(k, soil, i), largest_pressure(model, densest));
  return bounds;
}

double time_step(const TimeControl& time, const StepBounds& bounds, double max_speed, double max_acceleration) {
  if (time.fixed_step) return *time.fixed_step;
  const double dt = courant_step(bounds, max_speed, max_acceleration);
  return time.max_step ? std::min(dt, *time.max_step) : dt;
}

double first_step(const Model& model) {
  return time_step(model.time, step_bounds(model, flow_constants(model)), 0.0, norm(model.g));
}

Soil make_soil(const Model& model, const FlowConstants& k, const ParticlePlan& plan, const SoilProperties& properties) {
  const std::vector<SoilPoint>& points = plan.soil;
  const bool loaded = model.numerics.initial_pressure == InitialPressure::hydrostatic;
  Soil soil;
  for_each_state(soil, [&](const char*, auto& array) { array.assign(points.size(), 0.0); });
  soil.tan_phi = properties.tan_phi;
  apply_water(model, plan, soil.tan_phi);
  soil.c = properties.c;
  soil.rho0 = properties.rho0;
  soil.eta = properties.eta;
  const std::vector<double> ratios = load_ratios(model, points, properties.rho0);
  soil.x_sorted.resize(points.size());
  soil.y_sorted.resize(points.size());
  soil.material.resize(points.size());
  soil.id.resize(points.size());
  soil.n_active = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double above = loaded ? ratios[i] * mass_above(model.slide, model.materials, points[i].x) : 0.0;
    const double p = above * std::abs(model.g.y);
    soil.x[i] = points[i].x.x;
    soil.y[i] = points[i].x.y;
    soil.material[i] = points[i].material;
    soil.rho[i] = equation_of_state(k, soil, i).density(p);
    soil.m[i] = soil.rho0.empty() ? particle_mass(model, points[i]) : soil.rho0[i] * cell_area(model, points[i]);
    soil.id[i] = static_cast<std::int32_t>(i);
  }
  return soil;
}

WallParticles make_walls(const std::vector<WallPoint>& points, double dx, std::span<const Boundary> boundaries) {
  WallParticles walls;
  walls.volume = dx * dx;
  for (const WallPoint& w : points) {
    walls.x.push_back(w.x.x);
    walls.y.push_back(w.x.y);
    walls.nx.push_back(w.n.x);
    walls.ny.push_back(w.n.y);
    walls.depth.push_back(w.depth);
    const double foot = w.x.x + w.depth * w.n.x;
    walls.boundary.push_back(
        static_cast<std::int32_t>(friction_index(boundaries, static_cast<std::size_t>(w.boundary), foot)));
  }
  for_each_wall_real(walls, [&](const char*, auto& array) { array.assign(points.size(), 0.0); });
  return walls;
}

}  // namespace talus

#pragma once
// From a model to particles at rest, and the constants and scales that follow from it.

#include <cmath>
#include <span>
#include <vector>

#include "integrate/time_step.hpp"
#include "particles/fill.hpp"
#include "particles/geometry.hpp"
#include "particles/particles.hpp"
#include "simulation/model.hpp"
#include "simulation/run_result.hpp"
#include "sph/flow_constants.hpp"

namespace talus {

/// How many particles a model takes, before it is filled.
struct ParticleEstimate {
  double soil_area = 0.0;   ///< [m2]
  double row_length = 0.0;  ///< of all rows of wall particles together [m]

  /// N = A/dx^2 + L/dx at a spacing dx [m].
  double count(double dx) const { return soil_area / (dx * dx) + row_length / dx; }
  /// The spacing with which there are N particles [m].
  double spacing_for(double n) const {
    return (row_length + std::sqrt(row_length * row_length + 4.0 * n * soil_area)) / (2.0 * n);
  }
};
/// @param walls  as wall_lines() returns them
ParticleEstimate estimate_particles(const Model& model, std::span<const Polyline> walls);

/// Where the particles of a model start.
struct ParticlePlan {
  std::vector<SoilPoint> soil;
  std::vector<WallPoint> walls;
};
/// Fills the slide and lines the walls.
/// @throws ConfigError when there is no soil particle, or more particles than Model::max_particles
ParticlePlan plan_particles(const Model& model);

/// Mass of a particle of the plan per metre of width [kg/m].
double particle_mass(const Model& model, const SoilPoint& point);
/// Area that a particle of the plan stands for [m2].
double cell_area(const Model& model, const SoilPoint& point);
/// Mass that the particles of a plan carry, and that of the outlines.
SlideMass slide_mass(const Model& model, const ParticlePlan& plan);

/// Properties of the soil particles of a plan, in its order: those that may vary within a material.
struct SoilProperties {
  std::vector<double> tan_phi;    ///< tangent of the friction angle [-], >= 0
  std::vector<double> c;          ///< cohesion [Pa], >= 0
  std::vector<double> rho0 = {};  ///< reference density [kg/m3], > 0; empty: that of each material
  std::vector<double> eta = {};   ///< viscosity once it has yielded [Pa s], >= 0; empty: that of each material
};
/// The properties that the materials give.
SoilProperties material_properties(const Model& model, const ParticlePlan& plan);

/// c_s of the model, 10 sqrt(2 g H) with the fall height H unless given [m/s].
double sound_speed(const Model& model);
FlowConstants flow_constants(const Model& model);
/// What bounds the time step; the compression wave is that of the stiffest material: sqrt(c_s^2 + 4/3 G/rho0) with the
/// elastic law, c_s otherwise.
StepBounds step_bounds(const Model& model, const FlowConstants& k);
/// The same where density or viscosity vary from particle to particle: of the lightest and of the most viscous one.
StepBounds step_bounds(const Model& model, const FlowConstants& k, const Soil& soil);
/// Time step at these extrema of speed and acceleration: the fixed one, or Courant's up to the largest allowed [s].
double time_step(const TimeControl& time, const StepBounds& bounds, double max_speed, double max_acceleration);
/// First time step of the model [s], to estimate the number of steps.
double first_step(const Model& model);

/// The soil of a plan at rest, its density that of the initial pressure. The arrays of the state alone are filled.
/// Where the density varies, a particle carries the load of the outlines above it times the mean of rho0/rho0 of the
/// material over the particles above it in its column.
/// @param properties  as many values as the plan has soil particles
Soil make_soil(const Model& model, const FlowConstants& k, const ParticlePlan& plan, const SoilProperties& properties);
/// Wall particles without stress, in the order of the plan.
/// @param boundaries  whose stretches have frictions of their own
WallParticles make_walls(const std::vector<WallPoint>& points, double dx, std::span<const Boundary> boundaries);

}  // namespace talus

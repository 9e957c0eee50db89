#pragma once
// What is read off the particles: fronts, energy, momentum, digest.

#include <span>
#include <string>

#include "material/material.hpp"
#include "particles/geometry_input.hpp"
#include "particles/particles.hpp"
#include "simulation/run_result.hpp"

namespace talus {

/// Area of a soil particle at its reference density [m2].
inline double reference_area(const Soil& soil, std::span<const Material> materials, std::size_t i) {
  return soil.m[i] / (soil.rho0.empty() ? materials[static_cast<std::size_t>(soil.material[i])].rho0 : soil.rho0[i]);
}

/// Fronts and centre of mass as run-outs. The front at fixed thickness is that of the largest body, without soil that
/// left the terrain: the farthest place where it is terrain.front_thickness thick (simulation/thickness.hpp).
/// @param soil       not empty
/// @param dx         particle spacing [m]
/// @param materials  of the soil, by index
Measures measure_fronts(const Soil& soil, const Terrain& terrain, double dx, std::span<const Material> materials);

/// Keys of the measures that are lower bounds, since soil left through the open end towards which the slide goes:
/// fronts that reach that end, the front at fixed thickness of a connected body that does, and the centre of mass.
std::vector<std::string> lower_bounds(const Soil& soil, const Terrain& terrain, const Measures& measures);

/// What a reader of the measures must know: why one has no value, and that the farthest particle, or more than 1 % of
/// the mass, lies far ahead of the deposit.
/// @param front_thickness  [m]
/// @param dx               particle spacing [m]
std::vector<std::string> notes_on(const Measures& measures, double front_thickness, double dx);

/// Run-out of the farthest soil particle [m].
double farthest(const Soil& soil, const RunOutAxis& axis = {});
/// sum m [kg/m].
double total_mass(const Soil& soil);
/// sum m x / sum m [m].
Vec2 centre_of_mass(const Soil& soil);
/// sum m v^2 / 2 [J/m].
double kinetic_energy(const Soil& soil);
/// sqrt(2 E/M) of the active soil; 0 without any [m/s].
double rms_speed(const Soil& soil);
/// max |v| over the active soil [m/s].
double max_speed(const Soil& soil);

/// FNV-1a (64 bit) over position, velocity, density and elastic stress in order of id: 16 hex digits.
std::string digest(const Soil& soil);

}  // namespace talus

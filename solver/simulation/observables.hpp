#pragma once
// What is read off the particles: fronts, energy, momentum, digest.

#include <span>
#include <string>

#include "particles/particles.hpp"
#include "simulation/run_result.hpp"

namespace talus {

/// Fronts and centre of mass, from the left boundary at x = left [m]; dx is the particle spacing [m].
/// Soil must not be empty.
Measures measure_fronts(const Soil& soil, double left, double dx);

/// Farthest x of any soil particle [m].
double farthest(const Soil& soil);
/// sum m x / sum m [m].
double total_mass(const Soil& soil);  ///< [kg/m]
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

#pragma once
// Thickness, speed and dynamic pressure of the flow at a place.

#include <span>
#include <vector>

#include "material/material.hpp"
#include "particles/particles.hpp"
#include "simulation/target.hpp"

namespace talus {

/// The flow at a target at one moment; of a stretch the largest value along it.
struct TargetFlow {
  double depth = 0.0;             ///< thickness measured vertically [m]
  double speed = 0.0;             ///< depth-averaged, where the flow is as thick as the threshold; 0 elsewhere [m/s]
  double dynamic_pressure = 0.0;  ///< depth average of rho v^2, there [Pa]
};

/// Reach of the weight with which particles count to both sides of a place [m].
/// @param dx  particle spacing [m], > 0
double target_reach(double dx);

/// Sums over the particles that take part, with the weight w of thickness() (simulation/thickness.hpp), A = m/rho0:
///   depth = sum A w,  speed = |sum m v w| / sum m w,  dynamic pressure = sum m v^2 w / sum A w.
/// A stretch is sampled at places at most half the weight's reach apart.
/// @param materials  of the soil, by index
/// @param dx         particle spacing [m], > 0
/// The bits do not depend on the number of threads. Thread-safe.
TargetFlow flow_at(const Target& target, const Soil& soil, std::span<const Material> materials, double dx);

}  // namespace talus

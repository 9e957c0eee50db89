#pragma once
// The pore pressure that the soil has before the slide and carries along.

#include <cstdint>
#include <span>
#include <vector>

#include "particles/fill.hpp"
#include "simulation/model.hpp"

namespace talus {

/// lambda of each point, u over the total normal stress on a plane parallel to the ground above it: by r_u where its
/// material has one, else by the phreatic line; 0 in undrained and in dry soil. The slopes of ground and line are those
/// of their chords, as far to either side as the point is deep, so that a step of the survey does not count as a slope.
/// @return [-], >= 0, in the order of the points. Pure; thread-safe.
std::vector<double> pore_pressure_ratios(const Model& model, std::span<const SoilPoint> points);

/// Depth of each point below the top of the slide, vertically [m]. Pure; thread-safe.
std::vector<double> depths(const Model& model, std::span<const SoilPoint> points);

/// The water of a slide in three numbers.
struct PorePressureSummary {
  std::int64_t wet = 0;        ///< particles with a pore pressure
  std::int64_t liquefied = 0;  ///< of them, those without effective stress, lambda >= 1
  double mean = 0.0;           ///< of lambda over the wet ones [-]
};
PorePressureSummary summary_of(std::span<const double> ratios);

/// Whether a material, or the water, gives any soil a pore pressure.
bool has_pore_pressure(const Model& model);

}  // namespace talus

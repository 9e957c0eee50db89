#pragma once
// The random properties of a case on its particles.

#include <span>
#include <vector>

#include "random_field/property_fields.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/run_result.hpp"

namespace talus {

/// FieldSpec::properties of a case, ready to be drawn.
/// @throws ConfigError when there are no such fields
PropertyFields property_fields(const Model& model, const FieldSpec& spec);

/// Summary of the distributions; what is of a run is zero.
/// @param plan  of `model`
FieldSummary summary_of(const PropertyFields& fields, const ParticlePlan& plan);

/// Draws the properties with these coefficients. A density or viscosity that does not vary within a material goes into
/// `model`, so that such a run has the bits of a case that states the value.
/// @param properties  those of the materials on entry
/// @returns the summary, that of the run included
FieldSummary draw_properties(const PropertyFields& fields, const ParticlePlan& plan, std::span<const double> xi,
                             SoilProperties& properties, Model& model);

}  // namespace talus

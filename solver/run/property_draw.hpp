#pragma once
// The random properties of a case on its particles.

#include <span>
#include <vector>

#include "random_field/property_fields.hpp"
#include "run/field_spread.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/run_result.hpp"

namespace talus {

/// FieldSpec::properties of a case, ready to be drawn; conditioned on its data.
/// @throws ConfigError when there are no such fields
PropertyFields property_fields(const Model& model, const FieldSpec& spec);

/// Summary of the distributions; what is of a run is zero.
/// @param plan  of `model`
FieldSummary summary_of(const PropertyFields& fields, const Model& model, const ParticlePlan& plan);

/// As field_spread of realization.hpp. @param plan  of `model`
FieldSpread property_spread(const PropertyFields& fields, const Model& model, const ParticlePlan& plan,
                            Property property);

/// Draws the properties with these coefficients. A density or viscosity that does not vary within a material goes into
/// `model`, so that such a run has the bits of a case that states the value.
/// @param properties  those of the materials on entry
/// @returns the summary, that of the run included
FieldSummary draw_properties(const PropertyFields& fields, const ParticlePlan& plan, std::span<const double> xi,
                             SoilProperties& properties, Model& model);

}  // namespace talus

#pragma once
// The materials of a model and the random properties of its field: one as the other sees it.

#include <vector>

#include "random_field/property_laws.hpp"
#include "simulation/model.hpp"

namespace talus {

/// What the random field needs to know of the materials, in their order.
std::vector<FieldMaterial> field_materials(const Model& model);

/// What the trend multiplies tan(phi) with at a point of a material: tan(phi + slope depth) / tan(phi), phi being the
/// angle of the median at the surface.
/// @param slope  FieldSpec::trend [rad/m]
double trend_factor(const Model& model, double slope, double median_tan_phi, Vec2 point);

/// A datum of a field with properties, as it is without the trend.
/// @param given  on one of the properties, in soil of the slide
PropertyDatum property_datum(const Model& model, const FieldSpec& field, const PropertyLaws& laws,
                             const FieldDatum& given);

/// Gives materials a value of a property in SI units.
void set_property(Material& m, Property p, double value);

/// Where a property states its mean, the mean takes the place of the materials' value: time step, warnings and all else
/// that knows no realization are those of the mean soil.
/// @param field  without faults
void use_property_means(Model& model, const FieldSpec& field);

}  // namespace talus

#pragma once
// The materials of a model and the random properties of its field: one as the other sees it.

#include <vector>

#include "random_field/property_laws.hpp"
#include "simulation/model.hpp"

namespace talus {

/// What the random field needs to know of the materials, in their order.
std::vector<FieldMaterial> field_materials(const Model& model);

/// What depth makes of a value that is drawn from the distribution at the ground surface: its coefficient of variation
/// stays.
struct DepthChange {
  double factor = 1.0;      ///< of friction with a trend: tan(phi + slope depth) / tan(phi), phi that of the median
  double added = 0.0;       ///< of an undrained strength: gradient times depth [Pa]
  double at_surface = 0.0;  ///< of an undrained strength: the one at the surface that `added` belongs to [Pa]

  /// A constant strength has exactly at_surface + added.
  double of(double x) const { return factor * x + (at_surface > 0.0 ? added * (x / at_surface) : added); }
};

/// Of the k-th property at a point of a material that it applies to: a trend of friction, the gradient of an undrained
/// strength. Both are those of the mean, or of the median where the distribution is given by log_stdev.
/// @param slope  FieldSpec::trend [rad/m]
DepthChange depth_change(const Model& model, double slope, const PropertyLaws& laws, std::size_t k,
                         std::size_t material, Vec2 point);

/// A datum of a field with properties, as it would be at the ground surface.
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

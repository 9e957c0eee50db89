#include "case/field_materials.hpp"

#include <algorithm>
#include <cmath>

#include "particles/geometry.hpp"
#include "random_field/random_field.hpp"

namespace talus {

std::vector<FieldMaterial> field_materials(const Model& model) {
  std::vector<FieldMaterial> materials;
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const Material& m = model.materials[k];
    materials.push_back({.name = m.name,
                         .values = {std::tan(m.phi), m.c, m.rho0, m.eta},
                         .used = std::ranges::count(model.slide, static_cast<int>(k), &SlidePart::material) > 0,
                         .undrained = m.undrained});
  }
  return materials;
}

DepthChange depth_change(const Model& model, double slope, const PropertyLaws& laws, std::size_t k,
                         std::size_t material, Vec2 point) {
  const PropertySpec& p = laws.spec(k);
  const Marginal& marginal = laws.marginal(k, material);
  if (p.property == Property::friction && slope != 0.0)
    return {.factor = std::exp(log_trend(marginal.value(0.0), slope, depth_below_surface(model.slide, point)))};
  const double gradient = model.materials[material].c_gradient;
  if (p.property == Property::cohesion && gradient > 0.0)
    return {.added = gradient * depth_below_surface(model.slide, point),
            .at_surface = p.log_stdev ? marginal.value(0.0) : marginal.mean};
  return {};
}

PropertyDatum property_datum(const Model& model, const FieldSpec& field, const PropertyLaws& laws,
                             const FieldDatum& given) {
  const auto place = std::ranges::find(field.properties, given.property, &PropertySpec::property);
  PropertyDatum datum{.property = static_cast<std::size_t>(place - field.properties.begin()),
                      .material = static_cast<std::size_t>(material_at(model.slide, given.x)),
                      .x = given.x,
                      .value = given.value,
                      .error = given.error};
  if (given.property == Property::friction) {
    datum.value = std::tan(given.value);
    datum.error = given.error * (1.0 + datum.value * datum.value);  // d tan(phi)/d phi = 1 + tan(phi)^2
  }
  const double factor = depth_change(model, field.trend, laws, datum.property, datum.material, given.x).of(1.0);
  datum.value /= factor;
  datum.error /= factor;
  return datum;
}

void set_property(Material& m, Property p, double value) {
  switch (p) {
    case Property::friction:
      m.phi = std::atan(value);
      break;
    case Property::cohesion:
      m.c = value;
      break;
    case Property::unit_weight:
      m.rho0 = value;
      break;
    case Property::viscosity:
      m.eta = value;
      break;
  }
}

void use_property_means(Model& model, const FieldSpec& field) {
  const PropertyLaws laws(field, field_materials(model));
  for (std::size_t k = 0; k < field.properties.size(); ++k) {
    const PropertySpec& p = field.properties[k];
    const bool stated = p.mean || p.log_mean || (p.marginal == MarginalKind::uniform && p.low);
    if (!stated) continue;
    const auto materials = field_materials(model);
    for (std::size_t m = 0; m < model.materials.size(); ++m)
      if (laws.applies(k, m) && materials[m].used)
        set_property(model.materials[m], p.property, laws.marginal(k, m).mean);
  }
}

}  // namespace talus

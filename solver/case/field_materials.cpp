#include "case/field_materials.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

std::vector<FieldMaterial> field_materials(const Model& model) {
  std::vector<FieldMaterial> materials;
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const Material& m = model.materials[k];
    materials.push_back({.name = m.name,
                         .values = {std::tan(m.phi), m.c, m.rho0, m.eta},
                         .used = std::ranges::count(model.slide, static_cast<int>(k), &SlidePart::material) > 0});
  }
  return materials;
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

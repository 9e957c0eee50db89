// Whether the random field of a case can be drawn: what its keys say together, and with the soil.

#include <algorithm>
#include <cmath>
#include <string>

#include "case/field_materials.hpp"
#include "case/sections.hpp"
#include "math/angle.hpp"
#include "particles/geometry.hpp"
#include "random_field/property_fields.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr double most_trend_angle = radians(89.0);  ///< as of friction_angle_deg

/// Two keys that only the product modes of the separable exponential covariance have.
void check_covariance(const FieldSpec& f, Faults& faults) {
  if (f.covariance == Covariance::exponential || f.sampler != FieldSampler::karhunen_loeve) return;
  if (f.truncation == Truncation::diagonal)
    faults.add("/random_field/truncation",
               "\"diagonal\" pairs modes along x with modes along y, which only covariance exponential has; allowed: "
               "largest, variance_share");
  if (f.root_intervals == RootIntervals::paper)
    faults.add("/random_field/root_intervals", "\"paper\" is for covariance exponential; allowed: complete");
}

/// Whether the number of modes is known before they are solved, and every coefficient belongs to one.
bool counted_beforehand(const FieldSpec& f) {
  return f.sampler == FieldSampler::karhunen_loeve && f.truncation != Truncation::variance_share &&
         f.covariance == Covariance::exponential && f.nugget == 0.0 && f.data.empty();
}

/// Distributions and correlations that exist; coefficients as many as the properties take.
void check_properties(const Model& model, const FieldSpec& field, Faults& faults) {
  const std::vector<FieldMaterial> materials = field_materials(model);
  try {
    const PropertyLaws laws(field, materials);
  } catch (const ConfigError& e) {
    for (const Fault& fault : e.faults) faults.add(fault.pointer, fault.message);
  }
  for (const PropertySpec& p : field.properties)
    if (p.property == Property::viscosity)
      for (const Material& m : model.materials)
        if (m.mu_i && p.applies_to(m.name))
          faults.add(property_pointer(p.property),
                     "material " + in_quotes(m.name) + " has mu_i instead of a viscosity");
  const std::size_t needed = coefficients(property_blocks(field, materials, static_cast<std::size_t>(field.terms)));
  if (counted_beforehand(field) && !field.xi.empty() && field.xi.size() != needed)
    faults.add("/random_field/xi", "has " + std::to_string(field.xi.size()) + " coefficients, the properties take " +
                                       std::to_string(needed));
}

/// The friction angles of the median at the surface, which a trend raises [rad].
std::vector<double> surface_angles(const Case& c) {
  const FieldSpec& f = *c.field;
  std::vector<double> angles;
  if (!f.properties.empty()) {
    const std::vector<FieldMaterial> materials = field_materials(c.model);
    const PropertyLaws laws(f, materials);
    for (std::size_t m = 0; m < materials.size(); ++m)
      if (f.properties.front().property == Property::friction && materials[m].used && laws.applies(0, m))
        angles.push_back(std::atan(laws.marginal(0, m).value(0.0)));
    return angles;
  }
  for (const Material& m : c.model.materials)
    if (!m.undrained) angles.push_back(f.mean ? std::atan(*f.mean) : f.mu ? std::atan(std::exp(*f.mu)) : m.phi);
  return angles;
}

void check_trend(const Case& c, Faults& faults) {
  const FieldSpec& f = *c.field;
  if (f.trend == 0.0) return;
  const char* key = "/random_field/trend_deg_per_m";
  const std::vector<double> angles = surface_angles(c);
  if (angles.empty()) faults.add(key, "needs properties.friction, the median of which it raises");
  double deepest = greatest_depth(c.model.slide);
  for (const FieldDatum& datum : f.data) deepest = std::max(deepest, depth_below_surface(c.model.slide, datum.x));
  for (const double phi : angles) {
    const double at_depth = phi + f.trend * deepest;
    if (at_depth > 0.0 && at_depth < most_trend_angle) continue;
    faults.add(key, "makes a median friction angle of " + rounded(degrees(at_depth)) + " deg at the depth of " +
                        rounded(deepest) + " m, from " + rounded(degrees(phi)) +
                        " deg at the surface; it must stay between 0 and " + rounded(degrees(most_trend_angle)) +
                        " deg");
    return;
  }
}

/// Friction data in soil that has friction.
void check_friction_data(const Case& c, const FieldData& data, Faults& faults) {
  for (std::size_t k = 0; k < c.field->data.size(); ++k) {
    const FieldDatum& datum = c.field->data[k];
    const Material& m = c.model.materials[static_cast<std::size_t>(material_at(c.model.slide, datum.x))];
    if (datum.property == Property::friction && m.undrained)
      faults.add(data.places[k], "is a friction angle in the material " + in_quotes(m.name) +
                                     ", which is undrained and has none; leave the datum out");
  }
}

/// Data on properties that vary where they were measured, with values that their distributions have.
void check_property_data(const Case& c, const FieldData& data, Faults& faults) {
  const FieldSpec& f = *c.field;
  const std::vector<FieldMaterial> materials = field_materials(c.model);
  const PropertyLaws laws(f, materials);
  for (std::size_t k = 0; k < f.data.size(); ++k) {
    const FieldDatum& datum = f.data[k];
    std::string why;
    if (std::ranges::count(f.properties, datum.property, &PropertySpec::property) == 0)
      why = "cannot be met: properties does not state " + std::string(name_of(datum.property).key);
    else if (!materials[static_cast<std::size_t>(material_at(c.model.slide, datum.x))].used)
      why = to_text(datum.x) + " lies in no soil of the slide; leave the datum out";
    else
      why = laws.unmet(property_datum(c.model, f, laws, datum));
    if (!why.empty()) faults.add(data.places[k], why);
  }
}

}  // namespace

void check_field_choices(const Case& c, Faults& faults) {
  check_covariance(*c.field, faults);
  if (!c.field->properties.empty()) {
    check_properties(c.model, *c.field, faults);
    return;
  }
  const bool undrained = std::ranges::all_of(c.model.materials, &Material::undrained);
  if (undrained)
    faults.add("/random_field", "varies the friction angle, and every material is undrained, which has none");
  if (!undrained && !c.field->mu && !c.field->mean)
    for (const Material& m : c.model.materials)
      if (m.phi <= 0.0 && !m.undrained)
        faults.add("/random_field",
                   "needs log_mean or mean_tan_phi: material " + in_quotes(m.name) + " has no friction angle to vary");
  if (counted_beforehand(*c.field) && !c.field->xi.empty() &&
      c.field->xi.size() != static_cast<std::size_t>(c.field->terms))
    faults.add("/random_field/xi", "has " + std::to_string(c.field->xi.size()) + " coefficients, terms is " +
                                       std::to_string(c.field->terms));
}

void check_field(const Case& c, const SourceLocations& origins, Faults& faults) {
  const FieldSpec& f = *c.field;
  const Box box = bounding_box(c.model.slide);
  if (!f.data.empty() && f.properties.empty() && f.sigma == 0.0)
    faults.add("/random_field/data", "cannot be met: the standard deviation of the field is 0");
  const std::size_t before = faults.size();
  check_field_data(origins.field_data, f.domain.value_or(box), faults);
  check_trend(c, faults);
  check_friction_data(c, origins.field_data, faults);
  if (!f.properties.empty() && !f.data.empty() && faults.size() == before)
    check_property_data(c, origins.field_data, faults);
}

void warn_of_undrained_layers(const Case& c, std::vector<Fault>& warnings) {
  const FieldSpec& f = *c.field;
  const auto friction = std::ranges::find(f.properties, Property::friction, &PropertySpec::property);
  if (!f.properties.empty() && friction == f.properties.end()) return;
  std::string names;
  for (const FieldMaterial& m : field_materials(c.model)) {
    const bool meant = f.properties.empty() || friction->applies_to(m.name);
    if (m.used && m.undrained && meant) names += (names.empty() ? "" : ", ") + in_quotes(m.name);
  }
  if (!names.empty())
    warnings.push_back({f.properties.empty() ? "/random_field" : property_pointer(Property::friction),
                        "varies friction in the drained materials only; undrained, without friction: " + names});
}

}  // namespace talus

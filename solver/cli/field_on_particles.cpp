#include "cli/field_on_particles.hpp"

#include <algorithm>

#include "math/angle.hpp"
#include "support/error.hpp"

namespace talus::cli {
namespace {

std::string column_name(Property property) {
  if (property == Property::friction) return "friction_angle_deg";
  return std::string(name_of(property).key) + "_" + std::string(name_of(property).suffix);
}

/// The properties that the realizations of a case differ in; friction for a case without a field.
std::vector<Property> random_properties(const Strength& strength) {
  std::vector<Property> random;
  for (const PropertySummary& summary : strength.summary.properties) random.push_back(property_of(summary.name));
  if (random.empty()) random.push_back(Property::friction);
  return random;
}

void add_spread(const FieldSpread& spread, Property property, std::vector<Column>& columns) {
  std::vector<double> stdev = spread.stdev;
  for (double& value : stdev)
    value = property == Property::friction ? degrees(value) : value / name_of(property).factor;
  columns.push_back({"median_" + column_name(property), displayed(spread.median, property)});
  columns.push_back({"stdev_" + column_name(property), std::move(stdev)});
}

}  // namespace

Property property_of(std::string_view key) {
  return static_cast<Property>(std::ranges::find(property_names, key, &PropertyName::key) - property_names.begin());
}

Property first_random(const Case& problem) {
  if (!problem.field) return Property::friction;
  const auto& properties = problem.field->properties;
  const auto first = std::ranges::find_if(properties, [](const PropertySpec& p) {
    return p.random() && p.cov.value_or(1.0) > 0.0 && p.stdev.value_or(1.0) > 0.0 && p.log_stdev.value_or(1.0) > 0.0;
  });
  return first == properties.end() ? Property::friction : first->property;
}

std::vector<double> displayed(std::vector<double> values, Property property) {
  for (double& value : values)
    value = property == Property::friction ? friction_angle_deg(value) : value / name_of(property).factor;
  return values;
}

FieldOnParticles field_on(const Case& problem, const RunIdentity& identity, Property shown, bool spread) {
  const ParticlePlan plan = plan_particles(problem.model);
  FieldOnParticles field{.position = {},
                         .strength = strength(problem.model, problem.field, problem.study, plan, identity),
                         .columns = {},
                         .spreads = {},
                         .shown = shown,
                         .spread = {}};
  for (const SoilPoint& point : plan.soil) field.position.push_back(point.x);
  const std::vector<Property> random = random_properties(field.strength);
  if (shown != Property::friction && std::ranges::count(random, shown) == 0)
    throw ConfigError("/random_field", "does not draw " + std::string(name_of(shown).key) + ", which --property names");
  const auto add = [&](Property p) {
    field.columns.push_back({column_name(p), displayed(property_values(field.strength, plan, p), p)});
  };
  add(Property::friction);
  for (const Property p : random)
    if (p != Property::friction) add(p);
  if (!spread) return field;
  for (const Property p : random) add_spread(field_spread(problem.model, *problem.field, plan, p), p, field.spreads);
  field.spread = field_spread(problem.model, *problem.field, plan, shown);
  return field;
}

}  // namespace talus::cli

#include "run/realization.hpp"

#include <cmath>
#include <cstdint>

#include "run/friction_field.hpp"
#include "run/property_draw.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// @param field  RandomField or PropertyFields
template <class Field>
std::vector<double> draw(const Field& field, const FieldSpec& spec, const StudySpec& study,
                         const RunIdentity& identity) {
  if (!identity.realization) return spec.xi.empty() ? std::vector<double>(field.terms(), 0.0) : spec.xi;
  const auto index = static_cast<std::uint64_t>(*identity.realization);
  if (study.sampling == Sampling::monte_carlo) return field.draw(identity.seed, index);
  if (*identity.realization >= study.realizations)
    throw ConfigError("/study/realizations", "realization " + std::to_string(index) +
                                                 " lies outside the Latin hypercube of " +
                                                 std::to_string(study.realizations) + " realizations");
  return field.draw_stratified(identity.seed, static_cast<std::uint64_t>(study.realizations), index,
                               static_cast<std::size_t>(study.stratified_modes));
}

/// All of the summary but what is of a run, in the short form.
FieldSummary friction_summary(const FieldSpec& spec, const RandomField& field) {
  return {.captured_variance = field.captured_variance(),
          .cov = coefficient_of_variation(spec.sigma, field.variance()),
          .terms = static_cast<std::int64_t>(field.terms()),
          .embedding_error = field.embedding_error()};
}

/// The short form: a lognormal field of tan(phi).
void draw_friction(const FieldSpec& spec, const StudySpec& study, const ParticlePlan& plan, const RunIdentity& identity,
                   Strength& result) {
  std::vector<double>& tan_phi = result.properties.tan_phi;
  std::vector<Vec2> points;
  for (const SoilPoint& point : plan.soil) points.push_back(point.x);
  const RandomField random = make_field(result.model, spec);
  result.xi = draw(random, spec, study, identity);
  const std::vector<double> mu = log_medians_at(result.model, spec, random, points, tan_phi);
  tan_phi = lognormal(random.gaussian(points, result.xi), mu, spec.sigma);
  clear_undrained(result.model, plan, tan_phi);
  result.summary = friction_summary(spec, random);
}

}  // namespace

std::vector<double> property_values(const Strength& soil, const ParticlePlan& plan, Property property) {
  const SoilProperties& by_particle = soil.properties;
  const std::vector<double>* const arrays[] = {&by_particle.tan_phi, &by_particle.c, &by_particle.rho0,
                                               &by_particle.eta};
  const std::vector<double>& array = *arrays[index_of(property)];
  if (!array.empty()) return array;
  std::vector<double> values;
  for (const SoilPoint& point : plan.soil) {
    const Material& m = soil.model.materials[static_cast<std::size_t>(point.material)];
    values.push_back(property == Property::unit_weight ? m.rho0 : m.eta);
  }
  return values;
}

FieldSummary field_summary(const Model& model, const FieldSpec& spec, const ParticlePlan& plan) {
  if (!spec.properties.empty()) return summary_of(property_fields(model, spec), model, plan);
  return friction_summary(spec, make_field(model, spec));
}

FieldSpread field_spread(const Model& model, const FieldSpec& spec, const ParticlePlan& plan, Property property) {
  if (spec.properties.empty()) return friction_spread(model, spec, plan);
  return property_spread(property_fields(model, spec), model, plan, property);
}

Strength strength(const Model& model, const std::optional<FieldSpec>& field, const StudySpec& study,
                  const ParticlePlan& plan, const RunIdentity& identity) {
  Strength result{.properties = material_properties(model, plan), .model = model, .xi = {}, .summary = {}};
  if (field && !field->properties.empty()) {
    const PropertyFields fields = property_fields(model, *field);
    result.xi = draw(fields, *field, study, identity);
    result.summary = draw_properties(fields, plan, result.xi, result.properties, result.model);
  } else if (field) {
    draw_friction(*field, study, plan, identity, result);
  }
  std::vector<double>& tan_phi = result.properties.tan_phi;
  double sum = 0.0;
  for (double& value : tan_phi) {
    value *= 1.0 + identity.perturbation;
    sum += std::atan(value);
  }
  result.summary.mean_phi = sum / static_cast<double>(tan_phi.size());
  return result;
}

}  // namespace talus

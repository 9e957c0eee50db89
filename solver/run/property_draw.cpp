#include "run/property_draw.hpp"

#include <algorithm>
#include <cmath>

#include "case/field_materials.hpp"

namespace talus {
namespace {

std::vector<std::size_t> materials_of(const ParticlePlan& plan) {
  std::vector<std::size_t> materials;
  for (const SoilPoint& point : plan.soil) materials.push_back(static_cast<std::size_t>(point.material));
  return materials;
}

std::vector<Vec2> points_of(const ParticlePlan& plan) {
  std::vector<Vec2> points;
  for (const SoilPoint& point : plan.soil) points.push_back(point.x);
  return points;
}

/// What depth changes of the k-th property at each particle.
std::vector<DepthChange> depth_changes(const PropertyFields& fields, const Model& model, const ParticlePlan& plan,
                                       std::size_t k) {
  std::vector<DepthChange> changes;
  for (const SoilPoint& point : plan.soil) {
    const auto m = static_cast<std::size_t>(point.material);
    changes.push_back(fields.laws().applies(k, m) ? depth_change(model, fields.trend(), fields.laws(), k, m, point.x)
                                                  : DepthChange{});
  }
  return changes;
}

/// Mean and coefficient of variation of a mixture of distributions. Deviations from the first mean are summed, so that
/// equal values have exactly no variance.
struct Mixture {
  double n = 0.0, first = 0.0, sum = 0.0, squares = 0.0;

  void add(double mean, double stdev) {
    if (n == 0.0) first = mean;
    n += 1.0;
    sum += mean - first;
    squares += (mean - first) * (mean - first) + stdev * stdev;
  }
  double mean() const { return n > 0.0 ? first + sum / n : 0.0; }
  double cov() const {
    const double variance = n > 0.0 ? std::max(0.0, squares / n - (sum / n) * (sum / n)) : 0.0;
    return mean() != 0.0 ? std::sqrt(variance) / mean() : 0.0;
  }
};

/// The array that a property varies in from particle to particle, filled with the materials' values.
std::vector<double>& array_of(Property p, SoilProperties& properties, const Model& model, const ParticlePlan& plan) {
  if (p == Property::friction) return properties.tan_phi;
  if (p == Property::cohesion) return properties.c;
  std::vector<double>& array = p == Property::unit_weight ? properties.rho0 : properties.eta;
  for (const std::size_t m : materials_of(plan))
    array.push_back(p == Property::unit_weight ? model.materials[m].rho0 : model.materials[m].eta);
  return array;
}

bool in_the_loops(Property p) { return p == Property::friction || p == Property::cohesion; }

}  // namespace

PropertyFields property_fields(const Model& model, const FieldSpec& spec) {
  const std::vector<FieldMaterial> materials = field_materials(model);
  std::vector<PropertyDatum> data;
  if (!spec.data.empty()) {
    const PropertyLaws laws(spec, materials);
    for (const FieldDatum& datum : spec.data) data.push_back(property_datum(model, spec, laws, datum));
  }
  return PropertyFields(spec, materials, bounding_box(model.slide), model.dx, data);
}

FieldSummary summary_of(const PropertyFields& fields, const Model& model, const ParticlePlan& plan) {
  FieldSummary summary{.captured_variance = fields.captured_variance(),
                       .terms = static_cast<std::int64_t>(fields.terms()),
                       .embedding_error = fields.embedding_error()};
  const std::vector<std::size_t> materials = materials_of(plan);
  for (std::size_t k = 0; k < fields.laws().size(); ++k) {
    const Property property = fields.laws().spec(k).property;
    const std::vector<DepthChange> depth = depth_changes(fields, model, plan, k);
    Mixture all;
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const std::size_t m = materials[i];
      if (!fields.laws().applies(k, m)) continue;
      all.add(depth[i].of(fields.drawn(k, m).mean), depth[i].of(1.0) * fields.drawn(k, m).stdev);
    }
    const PropertyName& name = name_of(property);
    summary.properties.push_back({.name = std::string(name.key), .mean = all.mean() / name.factor, .cov = all.cov()});
    if (property == Property::friction) summary.cov = all.cov();
  }
  return summary;
}

FieldSpread property_spread(const PropertyFields& fields, const Model& model, const ParticlePlan& plan,
                            Property property) {
  const std::vector<std::size_t> materials = materials_of(plan);
  const std::vector<FieldMaterial> stated = field_materials(model);
  FieldSpread spread;
  for (const std::size_t m : materials) spread.median.push_back(stated[m].values[index_of(property)]);
  if (property == Property::cohesion) spread.median = material_properties(model, plan).c;  // with depth
  spread.stdev.assign(materials.size(), 0.0);
  for (std::size_t k = 0; k < fields.laws().size(); ++k) {
    if (fields.laws().spec(k).property != property) continue;
    const PropertyFields::Spread drawn = fields.spread(k, points_of(plan), materials);
    const std::vector<DepthChange> depth = depth_changes(fields, model, plan, k);
    for (std::size_t i = 0; i < materials.size(); ++i) {
      if (!fields.laws().applies(k, materials[i])) continue;
      spread.median[i] = depth[i].of(drawn.median[i]);
      spread.stdev[i] = depth[i].of(1.0) * drawn.stdev[i];
    }
  }
  if (property == Property::friction)  // d phi / d tan(phi) = 1/(1 + tan(phi)^2)
    for (std::size_t i = 0; i < materials.size(); ++i) spread.stdev[i] /= 1.0 + spread.median[i] * spread.median[i];
  return spread;
}

FieldSummary draw_properties(const PropertyFields& fields, const ParticlePlan& plan, std::span<const double> xi,
                             SoilProperties& properties, Model& model) {
  const std::vector<std::size_t> materials = materials_of(plan);
  const std::vector<Vec2> points = points_of(plan);
  std::vector<std::vector<double>> values = fields.values(points, materials, xi);
  FieldSummary summary = summary_of(fields, model, plan);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const PropertySpec& spec = fields.laws().spec(k);
    const std::vector<DepthChange> depth = depth_changes(fields, model, plan, k);
    for (std::size_t i = 0; i < depth.size(); ++i) values[k][i] = depth[i].of(values[k][i]);
    const bool by_particle = in_the_loops(spec.property) || spec.in_space();
    std::vector<double>* to = by_particle ? &array_of(spec.property, properties, model, plan) : nullptr;
    Mixture run;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!fields.laws().applies(k, materials[i])) continue;
      run.add(values[k][i], 0.0);
      if (to)
        (*to)[i] = values[k][i];
      else
        set_property(model.materials[materials[i]], spec.property, values[k][i]);
    }
    summary.properties[k].run_mean = run.mean() / name_of(spec.property).factor;
    summary.properties[k].run_cov = run.cov();
  }
  return summary;
}

}  // namespace talus

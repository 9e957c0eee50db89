#include "run/friction_field.hpp"

#include <cmath>

#include "particles/geometry.hpp"

namespace talus {
namespace {

/// The data of a case on the scale of Z.
std::vector<GaussianDatum> gaussian_data(const Model& model, const FieldSpec& spec, const RandomField& field) {
  std::vector<Vec2> points;
  std::vector<double> tan_phi;
  for (const FieldDatum& datum : spec.data) {
    points.push_back(datum.x);
    tan_phi.push_back(std::tan(model.materials[static_cast<std::size_t>(material_at(model.slide, datum.x))].phi));
  }
  const std::vector<double> mu = log_medians_at(model, spec, field, points, tan_phi);
  std::vector<GaussianDatum> data;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FieldDatum& datum = spec.data[i];
    data.push_back({points[i], (std::log(std::tan(datum.value)) - mu[i]) / spec.sigma,
                    datum.error * 2 / std::sin(2 * datum.value) / std::abs(spec.sigma)});
  }
  return data;
}

}  // namespace

RandomField make_field(const Model& model, const FieldSpec& spec) {
  RandomField field(spec, bounding_box(model.slide), model.dx);
  if (!spec.data.empty()) field.condition(gaussian_data(model, spec, field));
  return field;
}

std::vector<double> log_medians_at(const Model& model, const FieldSpec& spec, const RandomField& field,
                                   std::span<const Vec2> points, std::span<const double> tan_phi) {
  std::vector<double> mu;
  if (spec.mean) {
    mu = log_medians(*spec.mean, spec.sigma, field.variance(points));
  } else {
    for (const double median : tan_phi) mu.push_back(spec.mu.value_or(std::log(median)));
    if (spec.cell_average) {
      const std::vector<double> loss = field.averaging_loss(points);
      for (std::size_t i = 0; i < mu.size(); ++i) mu[i] += spec.sigma * spec.sigma * loss[i] / 2;
    }
  }
  if (spec.trend == 0.0) return mu;
  for (std::size_t i = 0; i < mu.size(); ++i) {
    const double at_surface = spec.mean ? *spec.mean : spec.mu ? std::exp(*spec.mu) : tan_phi[i];
    mu[i] += log_trend(at_surface, spec.trend, depth_below_surface(model.slide, points[i]));
  }
  return mu;
}

void clear_undrained(const Model& model, const ParticlePlan& plan, std::vector<double>& tan_phi) {
  for (std::size_t i = 0; i < tan_phi.size(); ++i)
    if (model.materials[static_cast<std::size_t>(plan.soil[i].material)].undrained) tan_phi[i] = 0.0;
}

FieldSpread friction_spread(const Model& model, const FieldSpec& spec, const ParticlePlan& plan) {
  std::vector<Vec2> points;
  for (const SoilPoint& point : plan.soil) points.push_back(point.x);
  const RandomField field = make_field(model, spec);
  const std::vector<double> mu = log_medians_at(model, spec, field, points, material_properties(model, plan).tan_phi);
  FieldSpread spread{lognormal(field.gaussian(points, std::vector<double>(field.terms(), 0.0)), mu, spec.sigma), {}};
  clear_undrained(model, plan, spread.median);
  const std::vector<double> variance = field.conditional_variance(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    spread.stdev.push_back(std::abs(spec.sigma) * std::sqrt(variance[i]) * std::sin(2 * std::atan(spread.median[i])) /
                           2);
  return spread;
}

}  // namespace talus

#include "run/realization.hpp"

#include <cmath>
#include <cstdint>
#include <span>

#include "random_field/random_field.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

std::vector<double> draw(const RandomField& field, const FieldSpec& spec, const StudySpec& study,
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

/// ln of the median at each particle: from the mean where the case gives it, else its own, else the material's.
std::vector<double> log_medians_at(const FieldSpec& spec, const RandomField& random, std::span<const Vec2> points,
                                   std::span<const double> tan_phi) {
  if (spec.mean) return log_medians(*spec.mean, spec.sigma, random.variance(points));
  std::vector<double> mu;
  for (const double median : tan_phi) mu.push_back(spec.mu.value_or(std::log(median)));
  return mu;
}

}  // namespace

FieldSummary field_summary(const FieldSpec& spec, const RandomField& field) {
  return {.captured_variance = field.captured_variance(),
          .cov = coefficient_of_variation(spec.sigma, field.variance()),
          .terms = static_cast<std::int64_t>(field.terms())};
}

Strength strength(const Model& model, const std::optional<FieldSpec>& field, const StudySpec& study,
                  const ParticlePlan& plan, const RunIdentity& identity) {
  Strength result{.properties = material_properties(model, plan), .xi = {}, .summary = {}};
  std::vector<double>& tan_phi = result.properties.tan_phi;
  if (field) {
    std::vector<Vec2> points;
    for (const SoilPoint& point : plan.soil) points.push_back(point.x);
    const RandomField random(*field, bounding_box(model.slide), model.dx);
    result.xi = draw(random, *field, study, identity);
    const std::vector<double> mu = log_medians_at(*field, random, points, tan_phi);
    tan_phi = lognormal(random.gaussian(points, result.xi), mu, field->sigma);
    result.summary = field_summary(*field, random);
  }
  double sum = 0.0;
  for (double& value : tan_phi) {
    value *= 1.0 + identity.perturbation;
    sum += std::atan(value);
  }
  result.summary.mean_phi = sum / static_cast<double>(tan_phi.size());
  return result;
}

}  // namespace talus

#include "run/warnings.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string_view>

#include "run/dissipation.hpp"
#include "run/realization.hpp"
#include "simulation/checks.hpp"
#include "simulation/pore_pressure.hpp"

namespace talus {
namespace {

constexpr double little_variance = 0.5;  ///< captured share of the variance that is warned of [-]
constexpr double inexact = 1e-6;         ///< error of a covariance that is warned of [-]

/// The key of the case that a check concerns.
std::string pointer_of(std::string_view check) {
  if (check == "few_particles_across") return "/particle_spacing_m";
  if (check == "mass_changed") return "/particle_placement";
  return check == "short_correlation_length" ? "/random_field" : "/time/fixed_step_s";
}

/// Soil without effective stress is allowed: it is a fluid.
void warn_of_liquefied_soil(const Model& model, const ParticlePlan& plan, std::vector<Fault>& warnings) {
  if (!has_pore_pressure(model)) return;
  const PorePressureSummary water = summary_of(pore_pressure_ratios(model, plan.soil));
  if (water.liquefied == 0) return;
  char text[240];
  std::snprintf(text, sizeof text,
                "leaves %lld of %zu particles without effective stress (pore pressure at or above the total normal "
                "stress): they are liquefied and have no friction",
                static_cast<long long>(water.liquefied), plan.soil.size());
  warnings.push_back({model.water.line.empty() ? "/material/r_u" : "/water", text});
}

}  // namespace

std::optional<double> shortest_correlation(const std::optional<FieldSpec>& field) {
  if (!field || field->cell_average || !field->in_space()) return std::nullopt;
  if (!field->along_y()) return field->ell_x;
  return field->along_x() ? std::min(field->ell_x, field->ell_y) : field->ell_y;
}

std::vector<Fault> warnings_before_run(const Case& c, const ParticlePlan& plan, const FieldSummary& field) {
  std::vector<Vec2> starts;
  for (const SoilPoint& point : plan.soil) starts.push_back(point.x);
  RunFacts facts = facts_before_run(c.model, starts);
  facts.correlation_length = shortest_correlation(c.field);
  const SlideMass mass = slide_mass(c.model, plan);
  facts.mass_change = mass.filled / mass.outline - 1.0;
  std::vector<Fault> warnings;
  for (const QualityReason& reason : assess(facts).reasons)
    warnings.push_back({pointer_of(reason.check), reason.message});
  std::ranges::move(dissipation_warnings(c.model), std::back_inserter(warnings));
  warn_of_liquefied_soil(c.model, plan, warnings);
  if (c.field && c.field->in_space() && field.captured_variance < little_variance) {
    const bool scaled = !c.field->properties.empty();
    char text[300];
    std::snprintf(text, sizeof text, "captures %.2g %% of the variance with %lld terms: %s",
                  100.0 * field.captured_variance, static_cast<long long>(field.terms),
                  scaled ? "the values have the stated distribution, but vary over longer distances than the "
                           "correlation length; take more terms, or circulant_embedding"
                         : "most of the stated variability never enters the runs");
    warnings.push_back({"/random_field", text});
  }
  if (field.embedding_error > inexact) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "is not exact: the grid is too large to be extended, and correlations are off by up to %.2g",
                  field.embedding_error);
    warnings.push_back({"/random_field/sampler", text});
  }
  return warnings;
}

std::vector<Fault> warnings_before_run(const Case& c) {
  const ParticlePlan plan = plan_particles(c.model);
  return warnings_before_run(c, plan, c.field ? field_summary(c.model, *c.field, plan) : FieldSummary{});
}

}  // namespace talus

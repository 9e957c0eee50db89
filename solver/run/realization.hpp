#pragma once
// One realization: from its identity to the properties of every soil particle.

#include <cstdint>
#include <optional>
#include <vector>

#include "random_field/field_spec.hpp"
#include "run/field_spread.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/run_result.hpp"
#include "study/plan.hpp"

namespace talus {

/// Which run of a case this is. Everything random follows from it.
struct RunIdentity {
  std::uint64_t seed = 0;
  std::optional<std::int64_t> realization;  ///< unset: the median run, every xi zero (or the xi that the case gives)
  double perturbation = 0.0;                ///< relative change of tan(phi), for replicates of the noise floor [-]
  bool operator==(const RunIdentity&) const = default;
};

/// The soil of a realization.
struct Strength {
  SoilProperties properties;  ///< of the soil particles, in the order of the plan
  Model model;                ///< the case's, its materials with what is drawn once for a whole material
  std::vector<double> xi;     ///< coefficients used; empty without a random field
  FieldSummary summary;
};

/// A property of the soil particles in SI units, in the order of the plan: of the particle, or of its material.
std::vector<double> property_values(const Strength& soil, const ParticlePlan& plan, Property property);

/// Median and standard deviation of a property of the soil particles over the realizations, given the data. The median
/// is drawn with every coefficient 0; a property that is not random has its value and no deviation.
/// @throws ConfigError when the field cannot be built
FieldSpread field_spread(const Model& model, const FieldSpec& spec, const ParticlePlan& plan, Property property);

/// What is known of a field before anything is drawn: all of the summary but what is of a run.
/// @throws ConfigError when the field cannot be built
FieldSummary field_summary(const Model& model, const FieldSpec& spec, const ParticlePlan& plan);

/// In the short form of the field tan(phi) = exp(mu + sigma Z(x)) (1 + perturbation), [Z20] Eq. 12; tan(phi) of the
/// material without a field. Where the case gives the mean of tan(phi), mu at each particle is such that tan(phi) has
/// this mean there (log_medians); the median run then has the median at each particle. With FieldSpec::properties each
/// of them as PropertyFields draws it; `perturbation` changes tan(phi) too. With Latin hypercube sampling the draws
/// depend on StudySpec::realizations, as they must.
/// @throws ConfigError when the field cannot be built or the realization lies outside a Latin hypercube study
Strength strength(const Model& model, const std::optional<FieldSpec>& field, const StudySpec& study,
                  const ParticlePlan& plan, const RunIdentity& identity);

}  // namespace talus

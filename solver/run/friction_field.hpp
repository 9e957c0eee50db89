#pragma once
// The short form of a random field, a lognormal tan(phi), on the particles of a case.

#include <span>
#include <vector>

#include "random_field/random_field.hpp"
#include "run/field_spread.hpp"
#include "simulation/particle_setup.hpp"

namespace talus {

/// The field of a case, conditioned on its data. A datum is taken to the scale of Z by the marginal at its place: z =
/// (ln tan(phi) - mu) / sigma, and its error by the slope there, d ln tan(phi) / d phi = 2 / sin(2 phi).
/// @throws ConfigError when the field cannot be built or the data cannot be met
RandomField make_field(const Model& model, const FieldSpec& spec);

/// ln of the median at points [-], shape of `points`: from the mean where the case gives it, else the field's own, else
/// the material's; with the trend. Averaging over cells keeps the mean of tan(phi), so that it moves the median up.
/// @param tan_phi  that of the material at each point [-]
std::vector<double> log_medians_at(const Model& model, const FieldSpec& spec, const RandomField& field,
                                   std::span<const Vec2> points, std::span<const double> tan_phi);

/// Undrained soil has no friction: its particles keep tan(phi) = 0, whatever the field.
/// @param tan_phi  of the particles of `plan` [-]
void clear_undrained(const Model& model, const ParticlePlan& plan, std::vector<double>& tan_phi);

/// Median and standard deviation of the friction angle at the particles: the latter to first order, sigma sqrt(V)
/// sin(2 phi) / 2.
FieldSpread friction_spread(const Model& model, const FieldSpec& spec, const ParticlePlan& plan);

}  // namespace talus

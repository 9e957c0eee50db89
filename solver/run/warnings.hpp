#pragma once
// What a run will be blamed for, said before it begins.

#include <vector>

#include "case/load.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/run_result.hpp"

namespace talus {

/// What the checks of the result object to already, dissipation that the numerics decide (dissipation.hpp), and a
/// random field that captures little of its variance; to be printed and kept beside LoadedCase::warnings.
std::vector<Fault> warnings_before_run(const Case& c, const ParticlePlan& plan, const FieldSummary& field);

/// The same, with particles and field made for it.
/// @throws ConfigError when there is no soil particle or the field cannot be built
std::vector<Fault> warnings_before_run(const Case& c);

/// Shortest correlation length of a random field along the axes on which it varies [m]; unset where it does not vary or
/// is averaged over cells.
std::optional<double> shortest_correlation(const std::optional<FieldSpec>& field);

}  // namespace talus

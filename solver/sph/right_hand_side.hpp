#pragma once
// The right-hand side of the landslide: neighbours -> velocity gradient -> stress -> walls -> acceleration.

#include "neighbours/cell_list.hpp"
#include "particles/particles.hpp"
#include "sph/flow_constants.hpp"
#include "sph/powers.hpp"
#include "sph/wall_load.hpp"

namespace talus {

/// Evaluates rates of change in double precision, one pair after the other: the plain loops, oracle of the vectorised
/// ones. Gather loops only: every particle sums its own neighbours in the order of the cells, so the result has the
/// same bits for any number of threads.
/// Fills ax, ay, drho, dt** and the derived p, s**, gamma_dot of the active soil, and the extrapolated stress of the
/// walls. With the elastic law it first returns t** to the yield surface. The reach of the cells must cover 2h around
/// every particle's present position.
/// @param powers  where not null: filled with the powers of every particle of the active soil
void evaluate_plain(const FlowConstants& k, Soil& soil, WallParticles& walls, const ParticleCells& cells,
                    ParticlePowers<double>* powers = nullptr);

/// Load of the active soil on a boundary, at the state that evaluate_plain() has evaluated.
WallLoad load_on(const FlowConstants& k, const Soil& soil, const WallParticles& walls, const ParticleCells& cells,
                 const LoadedBoundary& boundary);

/// One pass of the Shepard filter over the densities of the active soil.
void filter_density(const FlowConstants& k, Soil& soil, const WallParticles& walls, const ParticleCells& cells);

}  // namespace talus

#pragma once
// The flow of the soil over one time step, by one of two back ends.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "math/stopwatch.hpp"
#include "neighbours/cell_list.hpp"
#include "particles/particles.hpp"
#include "sph/right_hand_side.hpp"
#include "sph/step_extrema.hpp"
#include "sph/wall_load.hpp"

namespace talus {

/// Rates of density [kg/m3/s] and of elastic deviatoric stress [Pa/s].
struct ElasticRates {
  double drho, dtxx, dtyy, dtxy;
};

/// Evaluates the right-hand side and integrates it over a step. A back end keeps the rates of its last evaluation,
/// which the leapfrog needs for the next step; when particles are reordered the rates must follow.
/// Not thread-safe: one simulation owns one flow. The loops inside run on OpenMP's threads, with the same bits for any
/// number of them.
class Flow {
 public:
  explicit Flow(FlowConstants constants) : constants_(std::move(constants)) {}
  virtual ~Flow() = default;

  const FlowConstants& constants() const { return constants_; }
  /// "vectorised" or "plain".
  virtual const char* name() const = 0;
  /// The instruction set of its vectors ("AVX2", "AVX3_ZEN4", ...), or "none".
  virtual const char* simd() const = 0;

  /// Moves the active soil on by dt [s] and writes the stress extrapolated to the walls.
  /// The reach of `cells` covers 2h around every particle's position in the middle of the step.
  /// @param powers  where not null: filled with the powers in the middle of the step
  virtual StepExtrema step(Soil& soil, WallParticles& walls, const ParticleCells& cells, double dt,
                           Powers* powers = nullptr) = 0;

  /// From now on every step sums up the load of the soil on these boundaries.
  void observe_loads(std::vector<LoadedBoundary> boundaries) {
    loaded_ = std::move(boundaries);
    loads_.assign(loaded_.size(), {});
  }
  /// Loads in the middle of the last step on each of those boundaries, the sum of the soil-wall terms of the momentum
  /// equation with the opposite sign: what the soil's momentum loses, step by step.
  const std::vector<WallLoad>& loads() const { return loads_; }

  /// One pass of the Shepard filter over the densities of the active soil.
  void filter_density(Soil& soil, const WallParticles& walls, const ParticleCells& cells) {
    talus::filter_density(constants_, soil, walls, cells);
    state_changed();
  }

  /// How far a particle may move before the soil must be sorted again [h].
  virtual double resort_distance() const = 0;
  /// Rebuilds the Verlet lists, if the back end has them. To be called when the soil has been sorted, and again before
  /// a particle moves further than `skin` [m] from where it is now. No particle has moved further than
  /// `moved_since_sort` [m] since `cells` were built.
  virtual void rebuild_neighbour_lists(const Soil& soil, const WallParticles& walls, const ParticleCells& cells,
                                       double moved_since_sort, double skin) = 0;

  /// The rates follow the soil when all particles take a new order (index k <- index order[k]), and when two are
  /// exchanged.
  virtual void permute_rates(Soil& soil, std::span<const std::uint32_t> order, std::vector<double>& scratch) = 0;
  virtual void swap_rates(Soil& soil, std::size_t i, std::size_t j) = 0;

  /// Copies the rates, p, s** and gamma_dot of the last evaluation into the arrays of `to`, for frames and checkpoints.
  virtual void read_evaluation(const Soil& soil, Soil& to) const = 0;
  /// Takes them over from the arrays of `from`.
  virtual void write_evaluation(Soil& soil, const Soil& from) = 0;

  /// Of the last evaluation, of soil particle i.
  virtual ElasticRates elastic_rates(const Soil& soil, std::size_t i) const = 0;
  /// To be called when something else has changed cohesion or friction of the soil.
  virtual void strength_changed(const Soil&) {}
  /// To be called when something else has changed WallParticles::drag.
  virtual void drag_changed(const WallParticles&) {}

  /// Wall clock spent in the passes so far.
  const StageTimes& times() const { return times_; }

  /// To be called when something else than step() has changed the state of the soil.
  virtual void state_changed() {}

 protected:
  FlowConstants constants_;
  StageTimes times_;
  std::vector<LoadedBoundary> loaded_;
  std::vector<WallLoad> loads_;
};

/// Pressure of the density of soil particle i [Pa], with the tension cut-off where the options ask for it.
double initial_pressure(const FlowConstants& k, const Soil& soil, std::size_t i);

/// The back end that the constants ask for.
/// @param soil  in its initial state, with the arrays of for_each_state filled
std::unique_ptr<Flow> make_flow(FlowConstants constants, Soil& soil);

}  // namespace talus

#pragma once
// A deterministic run: particles made from a model, stepped to the end, read off as frames, history and result.

#include <cstdint>
#include <memory>

#include "integrate/flow.hpp"
#include "simulation/basal_drag.hpp"
#include "simulation/checkpoint_state.hpp"
#include "simulation/checks.hpp"
#include "simulation/energy_account.hpp"
#include "simulation/flow_thickness.hpp"
#include "simulation/frame.hpp"
#include "simulation/ground_contact.hpp"
#include "simulation/memory.hpp"
#include "simulation/model.hpp"
#include "simulation/neighbour_upkeep.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/run_result.hpp"
#include "simulation/strength_loss.hpp"
#include "simulation/target_gauges.hpp"

namespace talus {

/// Not thread-safe; step() and the observers use OpenMP's threads inside. The same bits come out for any number of
/// threads, and across a checkpoint.
class Simulation {
 public:
  /// @param properties  of the soil particles of `plan`, in its order
  Simulation(const Model& model, const ParticlePlan& plan, const SoilProperties& properties);
  /// With the properties that the materials give.
  Simulation(const Model& model, const ParticlePlan& plan)
      : Simulation(model, plan, material_properties(model, plan)) {}

  double time() const { return time_; }          ///< [s]
  std::int64_t steps() const { return steps_; }  ///< made so far
  const Soil& soil() const { return soil_; }
  const WallParticles& walls() const { return walls_; }
  const FlowConstants& constants() const { return flow_->constants(); }
  /// The back end that steps the soil, "vectorised" or "plain", and the instruction set of its vectors, or "none".
  const char* backend() const { return flow_->name(); }
  const char* simd() const { return flow_->simd(); }

  /// One time step, shortened so as not to pass `until` [s].
  /// @throws DivergedError naming step, time and particle
  void step(double until);
  /// Whether the stop-at-rest rule has been met.
  bool rests() const { return rest_rule_.rests(time_); }
  bool finished() const { return time_ >= model_.time.end || rests(); }

  /// All particles in order of id.
  Frame frame() const;
  HistoryRow history_row() const;
  /// One for each target.
  std::vector<TargetRow> target_rows() const;
  /// Where the energy of the run is and has gone.
  EnergyBudget energy() const;
  /// Everything but wall clock, threads, field and quality, which the caller knows.
  RunResult result() const;
  /// What the checks look at, but for the random field, which the caller knows.
  RunFacts facts() const;

  /// Wall clock spent in each stage of the steps so far.
  StageTimes times() const;

  /// For checkpoints: a simulation of the same model and plan goes on from it with the same bits.
  CheckpointState state() const;
  /// @throws IoError when the state does not belong to this model
  void restore(const CheckpointState& state);

 private:
  double choose_step(double until) const;
  StepExtrema flow_step(double dt);
  void filter_density_if_due();
  void lose_strength(double dt);
  void drag_along_the_bed();
  void check(const StepExtrema& extrema) const;
  [[noreturn]] void report_divergence() const;
  void meet_the_ground(StepExtrema& extrema);
  void add_loads(double dt);
  void retire_departed(const StepExtrema& extrema);
  double density_rise() const;
  double relative_speed() const;
  double run_on() const;
  double creep() const;
  bool at_rest() const;
  std::int64_t at_open_end() const;
  void add_friction_facts(RunFacts& f) const;
  std::vector<TargetOutcome> target_outcomes() const;
  SlideMass mass() const;
  void add_varying_properties(Frame& f) const;

  Model model_;
  Soil soil_;
  WallParticles walls_;
  std::unique_ptr<Flow> flow_;
  NeighbourUpkeep neighbours_;
  StartingPositions starts_;
  GroundContact contact_;
  BasalDrag drag_;
  StrengthLoss strength_loss_;
  EnergyAccount energy_account_;
  FlowThickness flow_thickness_;
  TargetGauges gauges_;
  RestRule rest_rule_;
  StepBounds bounds_;
  double time_ = 0.0;               ///< [s]
  double peak_speed_ = 0.0;         ///< over the run [m/s]
  double peak_density_rise_ = 0.0;  ///< largest rho/rho0 - 1 observed [-]
  double max_speed_ = 0.0;          ///< after the last step [m/s]
  double max_acceleration_ = 0.0;   ///< of the last evaluation [m/s2]
  std::int64_t steps_ = 0;
  std::int64_t evaluations_ = 0;  ///< of the right-hand side
  StageTimes times_;
};

}  // namespace talus

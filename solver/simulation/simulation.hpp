#pragma once
// A deterministic run: particles made from a model, stepped to the end, read off as frames, history and result.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "integrate/integrator.hpp"
#include "integrate/time_step.hpp"
#include "neighbours/cell_list.hpp"
#include "particles/geometry.hpp"
#include "particles/walls.hpp"
#include "simulation/frame.hpp"
#include "simulation/model.hpp"
#include "sph/right_hand_side.hpp"
#include "sph/vectorised_flow.hpp"

namespace talus {

/// Where the particles of a model start.
struct ParticlePlan {
  std::vector<SoilPoint> soil;
  std::vector<WallPoint> walls;
};
/// Fills the slide and lines the walls.
/// @throws ConfigError when there is no soil particle, or more particles than Model::max_particles
ParticlePlan plan_particles(const Model& model);

/// Fall height H [m]: highest point of the slide over the lowest point of bed and slide; sets the scale sqrt(2 g H) of
/// speed.
double fall_height(const Model& model);
/// c_s of the model, 10 sqrt(2 g H) unless given [m/s].
double sound_speed(const Model& model);
/// First time step of the model [s], to estimate the number of steps.
double first_step(const Model& model);

class Simulation {
 public:
  /// @param tan_phi  tangent of the friction angle of each soil particle of `plan`, in its order; empty: that of the
  /// material
  Simulation(const Model& model, const ParticlePlan& plan, std::vector<double> tan_phi = {});

  double time() const { return time_; }
  std::int64_t steps() const { return steps_; }
  const Soil& soil() const { return soil_; }
  const WallParticles& walls() const { return walls_; }
  const FlowConstants& constants() const { return rhs_.constants(); }

  /// One time step, shortened so as not to pass `until` [s].
  /// @throws DivergedError naming step, time and particle
  void step(double until);
  /// Has the stop-at-rest rule been met?
  bool rests() const;
  bool finished() const { return time_ >= model_.time.end || rests(); }

  Frame frame() const;
  HistoryRow history_row() const;
  /// Everything but wall clock, threads, ending and field, which the caller knows.
  RunResult result() const;

  /// Where the time of the steps went; only the vectorised loops tell their passes apart.
  StageTimes times() const;

  /// For checkpoints: restore(state()) goes on with the same bits.
  State state() const;
  /// @throws IoError when the state does not belong to this model
  void restore(const State& state);

  /// For tests: lets them set velocities and densities before the first step.
  Soil& mutable_soil() {
    if (fast_) fast_->state_changed();
    return soil_;
  }

 private:
  double choose_step(double until) const;
  Vec2 origin(std::int32_t id) const;
  void find_neighbours(double dt);
  void sort();
  void build_cells();
  void renew(double dt);
  void retire_departed(const Motion& motion);
  Motion plain_motion() const;
  void filter_density();
  void check(const Motion& motion);
  [[noreturn]] void report_divergence(double fastest2) const;
  void count_penetrations();

  Model model_;
  Polyline wall_line_;
  RightHandSide rhs_;
  Soil soil_;
  WallParticles walls_;
  std::optional<VectorisedFlow> fast_;  ///< unset: rhs_ evaluates
  CellList soil_cells_, wall_cells_;
  StepStart start_;
  FixedPoint origin_box_;
  std::vector<std::array<std::int32_t, 2>> origin_;  ///< starting position by id [quanta of origin_box_]
  std::vector<std::uint8_t> penetrated_;             ///< by id: ever seen behind the wall
  std::vector<double> scratch_;
  StepBounds bounds_;
  double time_ = 0.0, peak_speed_ = 0.0, max_speed_ = 0.0, max_acceleration_ = 0.0;
  double moved_ = -1.0;  ///< largest displacement since the last sort [m]; < 0: sort before the next step
  double way_ = 0.0, travelled_ = 0.0;  ///< that the lists of neighbours allow, and that may have been gone since [m]
  double slow_since_ = -1.0;  ///< time since when the slide has been slower than the rest speed; < 0: it is not
  double height_ = 0.0;
  std::int64_t steps_ = 0, evaluations_ = 0;
  StageTimes times_;
};

}  // namespace talus

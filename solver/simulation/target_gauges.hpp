#pragma once
// What the targets of a run have experienced so far.

#include <cstdint>
#include <span>
#include <vector>

#include "material/material.hpp"
#include "particles/geometry_input.hpp"
#include "particles/particles.hpp"
#include "simulation/flow_at.hpp"
#include "simulation/target.hpp"
#include "sph/wall_load.hpp"

namespace talus {

/// A line of the history of a target.
struct TargetRow {
  double time = 0.0;  ///< [s]
  std::int64_t step = 0;
  std::size_t target = 0;  ///< index into Model::targets
  TargetFlow flow;         ///< at that time
  WallLoad impulse;        ///< integral over time of the load since the start of the run [N s/m, N m s/m]
};

/// Observes the flow at every target of a model, and adds up the loads on its structures. Peaks of the flow are those
/// of every observation, peaks of loads those of means over Structure::averaging: neither depends on what is written
/// when. The bits do not depend on the number of threads. Not thread-safe.
class TargetGauges {
 public:
  /// @param to  direction of the slide, in which horizontal loads count
  TargetGauges(std::vector<Target> targets, SlidesTo to, double dx);

  const std::vector<Target>& targets() const { return targets_; }
  /// Structures among the targets, in their order, as the flow needs them to sum up the loads.
  const std::vector<LoadedBoundary>& structures() const { return structures_; }

  /// Takes in the flow at `time` [s].
  void observe(const Soil& soil, std::span<const Material> materials, double time);
  /// Takes in the loads of a step.
  /// @param loads  on each of structures(), in the middle of the step
  /// @param dt     length of the step [s]; @param time  at its end [s]
  void add_loads(std::span<const WallLoad> loads, double dt, double time);

  /// One row for each target.
  std::vector<TargetRow> rows(const Soil& soil, std::span<const Material> materials, double time,
                              std::int64_t step) const;
  /// What came of each target, its final depth included.
  /// @param rests       the run has come to rest
  /// @param rest_speed  flow that is slower than this has come to rest at its place [m/s]
  /// @param reachable   run-out that the soil may still reach [m]
  std::vector<TargetOutcome> outcomes(const Soil& soil, std::span<const Material> materials, const RunOutAxis& axis,
                                      bool rests, double rest_speed, double reachable) const;

  /// All that it remembers, for checkpoints.
  std::vector<double> state() const;
  /// @param state  as state() returned it, of that size
  void restore(const std::vector<double>& state);

 private:
  /// What is remembered of a target.
  struct Memory {
    double arrival = TargetOutcome::none;                                  ///< [s]
    TargetFlow peak;                                                       ///< largest values observed
    WallLoad impulse;                                                      ///< since the start
    WallLoad in_window;                                                    ///< since the present averaging time began
    double window_start = 0.0;                                             ///< [s]
    WallLoad mean;                                                         ///< over the last whole averaging time
    double peak_horizontal = 0.0, peak_downward = 0.0, peak_moment = 0.0;  ///< of such means
  };
  template <class AnyMemory, class Use>
  static void for_each_number(AnyMemory& memory, const Use& use);

  std::vector<Target> targets_;
  std::vector<LoadedBoundary> structures_;
  std::vector<std::size_t> target_of_structure_;
  double sign_;  ///< of a horizontal force in the direction of the slide
  double dx_;    ///< [m]
  std::vector<Memory> memory_;
};

}  // namespace talus

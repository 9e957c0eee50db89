#pragma once
// Where the energy of a run has gone so far.

#include <cstdint>
#include <vector>

#include "particles/particles.hpp"
#include "simulation/energy_budget.hpp"
#include "simulation/memory.hpp"
#include "sph/flow_constants.hpp"
#include "sph/powers.hpp"

namespace talus {

/// Elastic energy of the volume of all active soil [J/m].
double compression_energy(const FlowConstants& k, const Soil& soil);

/// Sums up the work of the powers that are measured every few steps, by the trapezoidal rule; what is stored it reads
/// off the soil. The bits do not depend on the number of threads.
class EnergyAccount {
 public:
  /// @param soil  at the start of the run
  EnergyAccount(const FlowConstants& k, const Soil& soil);

  /// Whether the next step, after `steps`, is to measure.
  bool due(std::int64_t steps) const;
  /// @param time  at which the powers were measured [s], not earlier than those before
  void measure(const Powers& powers, double time);
  /// What a density filter has taken off the energy of the volume [J/m].
  void filtered(double energy) { work_.density_diffusion += energy; }

  /// The balance at `time` [s]: the powers measured last go on until then.
  /// @param taken_by_contact  [J/m]
  EnergyBudget budget(const FlowConstants& k, const Soil& soil, const StartingPositions& starts, double time,
                      double taken_by_contact) const;

  /// All that it remembers, for checkpoints.
  std::vector<double> state() const;
  /// @param state  as state() returned it, of that size
  void restore(const std::vector<double>& state);

 private:
  Powers work_;  ///< until `measured_at_` [J/m]
  Powers last_;  ///< measured there [W/m]
  double measured_at_ = 0.0;
  bool measured_ = false;
  double stored_at_start_;
  double interval_;  ///< mean number of steps between two measurements
};

}  // namespace talus

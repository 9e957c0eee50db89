#pragma once
// The energy of a run: what is stored, and where the work of gravity went.

namespace talus {

/// Energies per metre of width [J/m] at one instant. Stored ones are states; the others are sums since the start of
/// the run, positive where energy leaves the soil. Gravity's work is initial minus present potential energy.
struct EnergyBudget {
  // Stored in the soil.
  double kinetic = 0.0;
  double potential = 0.0;    ///< sum of -m g.x, less its value at the start
  double compression = 0.0;  ///< elastic, of the volume
  double distortion = 0.0;   ///< elastic, of the deviatoric stress
  // Lost since the start.
  double friction = 0.0;              ///< plastic work of the yield stress
  double viscosity = 0.0;             ///< work of the viscous stress
  double artificial_viscosity = 0.0;  ///< work of Monaghan's term
  double density_diffusion = 0.0;     ///< work of delta-SPH and of the density filter
  double boundaries = 0.0;            ///< work done on the wall particles
  double contact = 0.0;               ///< taken where single particles meet the ground
  double departed = 0.0;              ///< carried away through an open end, all stored energies
  double stored_at_start = 0.0;       ///< of the four stored ones, at time 0

  double stored() const { return kinetic + potential + compression + distortion; }
  double lost() const {
    return friction + viscosity + artificial_viscosity + density_diffusion + boundaries + contact + departed;
  }
  /// Energy that no term explains; positive: made out of nothing.
  double created() const { return stored() + lost() - stored_at_start; }
};

}  // namespace talus

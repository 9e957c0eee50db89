#pragma once
// The energy of a run: what is stored, and where the work of gravity went. Formulas: README.md.

#include <optional>

namespace talus {

/// Energies per metre of width [J/m] at one instant. Stored ones are states of the soil that takes part; the others are
/// sums since the start of the run, positive where energy leaves the soil.
struct EnergyBudget {
  // Stored in the soil.
  double kinetic = 0.0;
  double potential = 0.0;    ///< sum of -m g.x over all soil, less its value at the start
  double compression = 0.0;  ///< elastic, of the volume
  double distortion = 0.0;   ///< elastic, of the deviatoric stress
  // Lost since the start.
  double friction = 0.0;   ///< work of the yield stress: that of the deviatoric stress not stored, not viscous
  double viscosity = 0.0;  ///< work of the viscous stress
  double artificial_viscosity = 0.0;  ///< work of Monaghan's term
  double density_diffusion = 0.0;     ///< work of delta-SPH, the density filter and the mass form of continuity
  double boundaries = 0.0;            ///< work done on the wall particles
  double contact = 0.0;               ///< taken where single particles meet the ground
  double departed = 0.0;              ///< kinetic and elastic energy carried away through an open end
  double stored_at_start = 0.0;       ///< of the four stored ones, at time 0

  double stored() const { return kinetic + potential + compression + distortion; }
  double lost() const {
    return friction + viscosity + artificial_viscosity + density_diffusion + boundaries + contact + departed;
  }
  /// Energy that no term explains; positive: made out of nothing.
  double created() const { return stored() + lost() - stored_at_start; }
  double gravity_work() const { return -potential; }
  /// What the method itself takes, and no soil.
  double numerical() const { return artificial_viscosity + density_diffusion; }
  /// Over gravity_work() [-]; unset where gravity has done no work.
  std::optional<double> created_share() const { return over_gravity(created()); }
  std::optional<double> numerical_share() const { return over_gravity(numerical()); }

  bool operator==(const EnergyBudget&) const = default;

 private:
  std::optional<double> over_gravity(double energy) const {
    return gravity_work() > 0.0 ? std::optional(energy / gravity_work()) : std::nullopt;
  }
};

/// A term as files name it.
struct EnergyTerm {
  const char* key;  ///< column of history.csv, member of result.json
  double EnergyBudget::*value;
};

inline constexpr EnergyTerm energy_terms[] = {
    {"kinetic_J_m", &EnergyBudget::kinetic},
    {"potential_J_m", &EnergyBudget::potential},
    {"compression_J_m", &EnergyBudget::compression},
    {"distortion_J_m", &EnergyBudget::distortion},
    {"friction_J_m", &EnergyBudget::friction},
    {"viscosity_J_m", &EnergyBudget::viscosity},
    {"artificial_viscosity_J_m", &EnergyBudget::artificial_viscosity},
    {"density_diffusion_J_m", &EnergyBudget::density_diffusion},
    {"boundaries_J_m", &EnergyBudget::boundaries},
    {"contact_J_m", &EnergyBudget::contact},
    {"departed_J_m", &EnergyBudget::departed},
    {"stored_at_start_J_m", &EnergyBudget::stored_at_start},
};

}  // namespace talus

#pragma once
// Soil that loses strength as it shears: the plastic shear strain of each particle, and its strength.

#include <cstdint>
#include <vector>

#include "integrate/flow.hpp"
#include "particles/particles.hpp"
#include "simulation/model.hpp"

namespace talus {

/// Width of a shear band that the method resolves, in particle spacings: the displacement across a band over the
/// plastic shear strain of its most strained particles. Measured, see solver/material/README.md.
inline constexpr double shear_band_spacings = 2.0;

/// Width of the shear bands of a material [m]: what it states, but no less than what the spacing resolves.
double shear_band_width(const Softening& softening, double dx);

/// Plastic strains are averaged over the stated width of the bands, exp(-r^2/(2 sigma^2)) with
/// sigma = width/sqrt(2 pi), so that a band that is thinner than it has a plastic strain of displacement/width whatever
/// its own width is (nonlocal plasticity: Bazant & Jirasek 2002, J. Eng. Mech. 128), and soil that shears evenly has
/// its own. Without a stated width the spacing itself is that length.
///
/// Holds peak and residual strength and plastic strain of every particle by id, where a material softens; otherwise it
/// holds nothing and costs nothing. Not thread-safe; the loop inside runs on OpenMP's threads, with the same bits for
/// any number of them.
class StrengthLoss {
 public:
  /// @param soil    at the start, with its peak strength, in order of id
  /// @param lambda  pore pressure ratio of each particle, by id; empty: dry [-]
  StrengthLoss(const Model& model, const FlowConstants& k, const Soil& soil, const std::vector<double>& lambda);

  bool active() const { return !strain_.empty(); }
  /// Adds the plastic strain that the coming step takes off the elastic stress, and lowers cohesion and friction of the
  /// soil. To be called before a step.
  /// @param ahead  from now to the first evaluation of the step [s]
  /// @param steps  made so far
  /// @return whether any strength has changed
  bool act(const Flow& flow, Soil& soil, double ahead, std::int64_t steps);

  /// Plastic shear strain by id [-], and what is to be averaged at the next multiple of the interval; for checkpoints.
  const std::vector<double>& strain() const { return strain_; }
  const std::vector<double>& pending() const { return pending_; }
  void restore(std::vector<double> strain, std::vector<double> pending) {
    strain_ = std::move(strain);
    pending_ = std::move(pending);
  }

 private:
  /// Of a particle.
  struct Range {
    double c_peak, c_residual;              ///< [Pa]
    double tan_phi_peak, tan_phi_residual;  ///< of total stress [-]
  };
  void average_pending(const Soil& soil);
  bool soften(Soil& soil);

  std::vector<double> residual_strain_;  ///< by material [-]; 0: does not soften
  std::vector<double> sigma_;            ///< of the average, by material [m]; 0: none
  std::vector<Range> strength_;          ///< by id
  std::vector<double> strain_;           ///< by id [-]
  std::vector<double> pending_;          ///< since the last average, by id [-]
};

}  // namespace talus

#pragma once
// The powers with which energy leaves the motion and the compression of the soil at one evaluation.

#include <cstddef>
#include <vector>

namespace talus {

/// Powers of the whole soil per metre of width [W/m]; positive where energy is taken.
struct Powers {
  double deviator = 0.0;              ///< of the deviatoric stress without its viscous part: distortion and friction
  double viscosity = 0.0;             ///< of the viscous stress
  double artificial_viscosity = 0.0;  ///< of Monaghan's term, walls included
  double density_diffusion = 0.0;     ///< of every change of density that is not the divergence of the velocity
  double boundaries = 0.0;            ///< of the stress between soil and walls
};

/// The same of every particle, as an evaluation writes them.
template <class Number>
struct ParticlePowers {
  std::vector<Number> deviator, viscosity, artificial_viscosity, density_diffusion, boundaries;

  void resize(std::size_t n) {
    for (auto* array : {&deviator, &viscosity, &artificial_viscosity, &density_diffusion, &boundaries})
      array->resize(n, Number(0));
  }
  /// Sums over the first n particles, in double precision and in their order.
  Powers total(std::size_t n) const {
    Powers sum;
    for (std::size_t i = 0; i < n; ++i) {
      sum.deviator += static_cast<double>(deviator[i]);
      sum.viscosity += static_cast<double>(viscosity[i]);
      sum.artificial_viscosity += static_cast<double>(artificial_viscosity[i]);
      sum.density_diffusion += static_cast<double>(density_diffusion[i]);
      sum.boundaries += static_cast<double>(boundaries[i]);
    }
    return sum;
  }
};

}  // namespace talus

#include "sph/flow_constants.hpp"

namespace talus {

std::vector<ConstitutiveParameters> constitutive_parameters(const std::vector<Material>& materials,
                                                            const Rheology& rheology, double c_s) {
  std::vector<ConstitutiveParameters> soils;
  for (const Material& m : materials)
    soils.push_back({.eos = EquationOfState::weakly_compressible(m.rho0, c_s),
                     .c = m.c,
                     .eta = m.eta,
                     .G = rheology.G.value_or(0.1 * m.rho0 * c_s * c_s)});
  return soils;
}

}  // namespace talus

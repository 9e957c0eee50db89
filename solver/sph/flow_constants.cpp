#include "sph/flow_constants.hpp"

namespace talus {

std::vector<PointLaw> point_laws(const std::vector<Material>& materials, const Rheology& rheology, double c_s) {
  std::vector<PointLaw> laws;
  for (const Material& m : materials)
    laws.push_back({EquationOfState::weakly_compressible(m.rho0, c_s),
                    m.c,
                    {m.eta, rheology.gamma_dot_min},
                    rheology.G.value_or(0.1 * m.rho0 * c_s * c_s)});
  return laws;
}

}  // namespace talus

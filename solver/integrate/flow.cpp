#include "integrate/flow.hpp"

#include "integrate/plain_flow.hpp"
#include "integrate/vectorised_flow.hpp"

namespace talus {

double initial_pressure(const FlowConstants& k, const Soil& soil, std::size_t i) {
  const double p = k.soils[static_cast<std::size_t>(soil.material[i])].eos.pressure(soil.rho[i]);
  return k.numerics.tension_cutoff ? apply_tension_cutoff(p) : p;
}

std::unique_ptr<Flow> make_flow(FlowConstants constants, Soil& soil) {
  if (VectorisedFlow::serves(constants.numerics)) return std::make_unique<VectorisedFlow>(std::move(constants), soil);
  return std::make_unique<PlainFlow>(std::move(constants), soil);
}

}  // namespace talus

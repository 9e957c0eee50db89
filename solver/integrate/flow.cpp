#include "integrate/flow.hpp"

#include "integrate/plain_flow.hpp"
#include "integrate/vectorised_flow.hpp"
#include "material/constitutive_models-inl.hpp"

namespace talus {

double initial_pressure(const FlowConstants& k, const Soil& soil, std::size_t i) {
  using namespace HWY_NAMESPACE;
  const EquationOfState eos = equation_of_state(k, soil, i);
  const double p = pressure(eos.B, soil.rho[i] / eos.rho0 - 1.0);
  return k.numerics.tension_cutoff ? apply_tension_cutoff(p) : p;
}

std::unique_ptr<Flow> make_flow(FlowConstants constants, Soil& soil) {
  if (VectorisedFlow::serves(constants.numerics)) return std::make_unique<VectorisedFlow>(std::move(constants), soil);
  return std::make_unique<PlainFlow>(std::move(constants), soil);
}

}  // namespace talus

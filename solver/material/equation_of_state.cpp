#include "material/equation_of_state.hpp"

#include <cmath>

#include "material/equation_of_state-inl.hpp"

namespace talus {

double EquationOfState::pressure(double rho) const { return HWY_NAMESPACE::pressure(B, rho / rho0 - 1.0); }

double EquationOfState::density(double p) const { return rho0 * std::pow(1.0 + p / B, 1.0 / eos_exponent); }

double apply_tension_cutoff(double p) { return HWY_NAMESPACE::apply_tension_cutoff(p); }

}  // namespace talus

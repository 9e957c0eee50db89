// From the velocity gradient to stress and rates: what happens at one point, for every number type. Included once for
// every instruction set.

#if defined(TALUS_SPH_POINT_UPDATE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_POINT_UPDATE_INL
#undef TALUS_SPH_POINT_UPDATE_INL
#else
#define TALUS_SPH_POINT_UPDATE_INL
#endif

#include <hwy/highway.h>

#include "material/constitutive_models-inl.hpp"
#include "material/equation_of_state-inl.hpp"
#include "sph/continuity-inl.hpp"
#include "sph/flow_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Pressure, stress, and the rates of density and elastic stress.                [Z20] Eqs. 1, 3-10
/// @param tan_phi  of the soil, or of the wall that it slides along
/// @param at       the point, or the points of a cluster: q(), c(), constant(get) of its ConstitutiveParameters;
///                 elastic() as the model needs it; set_stress(s, p), set_rates(drho, gamma_dot)
template <class Real, class Model, class Point>
HWY_INLINE void update_point(const FlowConstants& k, const Model& model, const FlowRates<Real>& rates, Real tan_phi,
                             Point&& at) {
  using Parameters = const ConstitutiveParameters&;
  const Real q = at.q();
  Real p = pressure(at.constant([](Parameters soil) { return soil.eos.B; }), q);
  if (k.numerics.tension_cutoff) p = apply_tension_cutoff(p);
  const Deviator<Real> e = deviatoric_strain_rate(rates.L);
  const PointState<Real> state{.e = e,
                               .two_spin = two_spin(rates.L),
                               .gamma_dot = shear_rate(e, k.rheology.shear_rate),
                               .tau_y = yield_stress(at.c(), tan_phi, p),
                               .eta = at.constant([](Parameters soil) { return soil.eta; }),
                               .two_G = at.constant([](Parameters soil) { return 2.0 * soil.G; })};
  at.set_stress(cauchy(p, model.stress(state, at.elastic())), p);
  // drho/dt = -rho expansion + rho0 diffusion
  const Real rho0 = at.constant([](Parameters soil) { return soil.eos.rho0; });
  at.set_rates(rho0 * fnma(q + Real(1.0), rates.expansion, rates.diffusion), state.gamma_dot);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

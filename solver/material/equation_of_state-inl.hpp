// The equation of state for every number type. Included once for every instruction set.

#if defined(TALUS_MATERIAL_EQUATION_OF_STATE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_MATERIAL_EQUATION_OF_STATE_INL
#undef TALUS_MATERIAL_EQUATION_OF_STATE_INL
#else
#define TALUS_MATERIAL_EQUATION_OF_STATE_INL
#endif

#include <hwy/highway.h>

#include "material/equation_of_state.hpp"
#include "math/number.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// p = B ((1 + q)^7 - 1), q = rho/rho0 - 1                                 [Z20] Eq. 3
/// Multiplied out, so that nothing cancels near the reference density.
template <class Real>
HWY_INLINE Real pressure(Real B, Real q) {
  static_assert(eos_exponent == 7.0);
  Real sum = q + Real(7.0);
  for (const double binomial : {21.0, 35.0, 35.0, 21.0, 7.0}) sum = fma(q, sum, Real(binomial));
  return B * q * sum;
}

/// Loose soil carries no tension: negative pressure is cut off.
template <class Real>
HWY_INLINE Real apply_tension_cutoff(Real p) {
  return max(p, Real(0.0));
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

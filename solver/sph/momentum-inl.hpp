// The momentum equation, for every number type. Included once for every instruction set.

#if defined(TALUS_SPH_MOMENTUM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_MOMENTUM_INL
#undef TALUS_SPH_MOMENTUM_INL
#else
#define TALUS_SPH_MOMENTUM_INL
#endif

#include <hwy/highway.h>

#include "math/tensor-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// dv_i/dt = sum_j m_j ((sigma_i + sigma_j)/(rho_i rho_j) - Pi_ij I) . grad_i W_ij + g    [Z20] Eq. 2
///         = (1/rho_i) sum_j V_j (sigma_i + sigma_j - rho_i rho_j Pi_ij I) . F r_ij + g
/// Adds the term of one neighbour to the sum. Antisymmetric in i and j but for V_j/rho_i, so that pairs conserve linear
/// momentum.
template <class Real>
HWY_INLINE Vector<Real> add_force(Vector<Real> sum, Symmetric<Real> s_i, Symmetric<Real> s_j, Real rho_rho_Pi, Real VF,
                                  Vector<Real> r_ij) {
  const Symmetric<Real> s = s_i + s_j;
  const Symmetric<Real> with_viscosity{s.xx - rho_rho_Pi, s.yy - rho_rho_Pi, s.xy};
  return fma(VF, with_viscosity * r_ij, sum);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Diffusion of density (delta-SPH), for every number type. Included once for every instruction set.

#if defined(TALUS_SPH_DENSITY_DIFFUSION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_DENSITY_DIFFUSION_INL
#undef TALUS_SPH_DENSITY_DIFFUSION_INL
#else
#define TALUS_SPH_DENSITY_DIFFUSION_INL
#endif

#include <hwy/highway.h>

#include "math/tensor-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// rho/rho0 - 1 without what the weight of the soil above adds to it, q - g.x/c_s^2, up to a constant.
/// Linearising the hydrostatic density costs a relative (chi - 1) p/(chi B), below 1 % of a difference that is itself
/// below 1 %.
template <class Real>
HWY_INLINE Real dynamic_density(Real q, Vector<Real> g_per_c2, Vector<Real> x) {
  return q - (g_per_c2.x * x.x + g_per_c2.y * x.y);
}

/// d(rho_i/rho0)/dt += 2 delta h c_s sum_j V_j (q_j - q_i) (r_ji . grad_i W_ij)/r^2, q the dynamic density
/// delta-SPH with the hydrostatic part taken out (Antuono 2010; Fourtakas 2019, linearised). Adds the term of one
/// neighbour of the same material to the sum: r_ji . grad_i W_ij = -F r^2.
template <class Real>
HWY_INLINE Real add_diffusion(Real sum, Real minus_VF, Real q_ji) {
  return fma(minus_VF, q_ji, sum);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Where the energy goes: the powers of a point and of a pair, for every number type. Included once for every
// instruction set.
//
// The momentum equation and the velocity gradient are conjugate: for pairs of soil particles
//   sum_i m_i v_i.a_i = sum_i m_i g.v_i - sum_i V_i sigma_i:L_i - (1/2) sum_ij V_i V_j rho_i rho_j Pi_ij F v_ij.r_ij
// exactly, whatever the positions. Pairs with a wall add what the wall's force does beyond its share of sigma_i:L_i.

#if defined(TALUS_SPH_ENERGY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_ENERGY_INL
#undef TALUS_SPH_ENERGY_INL
#else
#define TALUS_SPH_ENERGY_INL
#endif

#include <hwy/highway.h>

#include "math/tensor-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Powers of the stress of a particle [W/m].
template <class Real>
struct StressPowers {
  Real deviator, viscosity, density_diffusion;
};

/// V sigma:L = -V p tr(L) + V t:dev(e), t = t' + 2 eta dev(e): the power of t' is stored or lost by friction, that of
/// 2 eta dev(e) is lost by viscosity. Of the first term, continuity without diffusion stores V p expansion,
/// p/rho^2 drho/dt; the rest is lost to what changes the density otherwise, rho0 diffusion above all.
/// @param V  volume [m3/m]
/// @param p  pressure that the particle acts with [Pa]
/// @param t  deviatoric stress [Pa]
/// @param e  deviatoric strain rate [1/s]
/// @param divergence, expansion, diffusion  tr(L), and those of FlowRates [1/s]
/// @param q  rho/rho0 - 1 [-]
template <class Real>
HWY_INLINE StressPowers<Real> stress_powers(Real V, Real p, Deviator<Real> t, Deviator<Real> e, Real eta,
                                            Real divergence, Real expansion, Real diffusion, Real q) {
  const Real viscosity = V * (eta + eta) * double_dot(e, e);
  return {fms(V, double_dot(t, e), viscosity), viscosity,
          V * p * (expansion - divergence - diffusion / (q + Real(1.0)))};
}

/// Sums over the neighbours of one particle i, without V_i and the normalisation of the kernel.
template <class Real>
struct PairPowers {
  Real soil_viscosity, wall_viscosity, boundaries;

  static HWY_INLINE PairPowers zero() {
    const Real zero(0.0);
    return {zero, zero, zero};
  }

  /// V_j rho_i rho_j Pi_ij F v_ij.r_ij
  HWY_INLINE void add_soil(Real rho_rho_Pi, Real VF, Real v_dot_r) {
    soil_viscosity = fma(VF * rho_rho_Pi, v_dot_r, soil_viscosity);
  }
  /// V_w F (v_w.sigma_i.r_iw + v_i.sigma_w.r_iw), v_w = v_i - v_iw the virtual velocity of the wall particle, and
  /// V_w rho_i rho_i Pi_iw F v_i.arm: a wall stands still and does not share the loss.
  /// @param arm  r_iw, or the part of it that the artificial viscosity acts along
  HWY_INLINE void add_wall(Symmetric<Real> s_i, Symmetric<Real> s_w, Real rho_rho_Pi, Real VF, Vector<Real> v_i,
                           Vector<Real> v_iw, Vector<Real> r_iw, Vector<Real> arm) {
    wall_viscosity = fma(VF * rho_rho_Pi, dot(v_i, arm), wall_viscosity);
    boundaries = fma(VF, dot(v_i - v_iw, s_i * r_iw) + dot(v_i, s_w * r_iw), boundaries);
  }

  /// Taken by the artificial viscosity: the two particles of a pair share its power.
  HWY_INLINE Real taken_by_viscosity(Real V_to_F) const {
    return V_to_F * fma(Real(0.5), soil_viscosity, wall_viscosity);
  }
  HWY_INLINE Real taken_by_boundaries(Real V_to_F) const { return (Real(0.0) - V_to_F) * boundaries; }
};

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// The momentum equation and its artificial viscosity, for every number type. Included once for every instruction set.

#if defined(TALUS_SPH_MOMENTUM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_MOMENTUM_INL
#undef TALUS_SPH_MOMENTUM_INL
#else
#define TALUS_SPH_MOMENTUM_INL
#endif

#include <hwy/highway.h>

#include "math/tensor-inl.hpp"
#include "sph/flow_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Pi_ij = -mu (alpha c_s + beta |mu|)/rho_mean, mu = h J/(r^2 + 0.01 h^2), of the jump J of the velocity along r_ij.
/// Monaghan 1992, cited by [Z20] Eq. 2, whose J is v_ij.r_ij of approaching pairs and 0 of others. Here as rho_i rho_j
/// Pi_ij, which the momentum equation needs.
/// `Quadratic`: beta is not zero.
template <class Real, bool Quadratic>
struct ArtificialViscosity {
  Real alpha_c;  ///< -alpha c_s [m/s]
  Real beta;     ///< [-]
  Real h, soft;  ///< smoothing length, and 0.01 h^2, in the unit of the distances

  /// @param unit  of the distances [m]
  HWY_INLINE ArtificialViscosity(const FlowConstants& k, double unit)
      : alpha_c(-k.numerics.alpha * k.c_s),
        beta(k.numerics.beta),
        h(k.h / unit),
        soft(0.01 * k.h * k.h / (unit * unit)) {}

  /// What all pairs of a particle i have in common: 2 h rho_i, times -alpha c_s where the law is linear.
  HWY_INLINE Real of_particle(Real rho_i) const {
    const Real h_rho = Real(2.0) * h * rho_i;
    return Quadratic ? h_rho : h_rho * alpha_c;
  }

  /// rho_i rho_j Pi_ij = -(rho_i rho_j/rho_mean) mu (alpha c_s + beta |mu|)
  HWY_INLINE Real operator()(Real of_i, Real rho_i, Real rho_j, Real jump, Real r2) const {
    const Real soft_r2 = r2 + soft;
    const Real linear = of_i * jump * (rho_j / ((rho_i + rho_j) * soft_r2));
    if constexpr (!Quadratic) return linear;
    return linear * fnma(beta, h * abs(jump) / soft_r2, alpha_c);
  }
};

/// What the artificial viscosity of two soil particles acts on, if their velocities are reconstructed: of v_ij.r_ij
/// that part which their strain rates do not explain, J = v_ij.r_ij - S with S = r_ij.(e_i + e_j)/2.r_ij (after
/// Frontiere et al. 2017), times (J/(|J| + |S|))^2. Monaghan's term acts on the whole v_ij.r_ij, so that it resists
/// smooth shear as a viscosity of about rho alpha c_s h/8 would, which falls with the spacing and decides how far a
/// slide runs. In smooth shear J is the error of the strain rates, a small part of S, and the square removes it; where
/// particles shake, S is small and J acts whole. Both signs count: damping of approaching pairs alone is a pressure,
/// which lifts a sheared layer and drives its toe outwards. Bounded by v_ij.r_ij and zero: it never takes more than
/// Monaghan's term with both signs would and never feeds energy.
/// @param smooth  S
template <class Real>
HWY_INLINE Real unexplained_jump(Real v_dot_r, Real smooth) {
  const Real zero(0.0), least(1e-30);
  const Real left = v_dot_r - smooth, share = left / (abs(left) + abs(smooth) + least);
  return min(max(left * (share * share), min(v_dot_r, zero)), max(v_dot_r, zero));
}

/// The part of r_ij across the wall. With reconstruction the artificial viscosity between soil and wall acts on the
/// velocity across the wall alone, and across it: soil that slides along a wall is slowed by friction, not by numerics.
/// @param n  unit normal of the wall
template <class Real>
HWY_INLINE Vector<Real> across_wall(Vector<Real> r_ij, Vector<Real> n) {
  return dot(r_ij, n) * n;
}

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
/// The same where the artificial viscosity acts along `arm`, a part of r_ij.
template <class Real>
HWY_INLINE Vector<Real> add_force(Vector<Real> sum, Symmetric<Real> s_i, Symmetric<Real> s_j, Real rho_rho_Pi, Real VF,
                                  Vector<Real> r_ij, Vector<Real> arm) {
  return fma(VF, (s_i + s_j) * r_ij - rho_rho_Pi * arm, sum);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

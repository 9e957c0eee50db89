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
#include "sph/wall-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Pi_ij = -mu (alpha c_s + beta |mu|)/rho_mean, mu = h v_ij.r_ij/(r^2 + 0.01 h^2), where particles approach.
/// Monaghan 1992, cited by [Z20] Eq. 2. Here as rho_i rho_j Pi_ij, which the momentum equation needs.
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
  /// @param jump  v_ij.r_ij where it is negative, otherwise 0
  HWY_INLINE Real operator()(Real of_i, Real rho_i, Real rho_j, Real jump, Real r2) const {
    const Real soft_r2 = r2 + soft;
    const Real linear = of_i * jump * (rho_j / ((rho_i + rho_j) * soft_r2));
    if constexpr (!Quadratic) return linear;
    return linear * fnma(beta, h * abs(jump) / soft_r2, alpha_c);
  }
};

/// The artificial viscosity of two soil particles whose velocities are reconstructed:
///   rho_i rho_j Pi_ij = -rho_mean mu (alpha c_s + beta |mu|), mu = w h v_ij.r_ij/(r^2 + 0.01 h^2),
///   w = (J^2/(J^2 + 4 S^2))^2, S = r_ij.(e_i + e_j)/2.r_ij, J = v_ij.r_ij - S.
/// S is what the strain rates explain of v_ij.r_ij, J what they do not (after Frontiere et al. 2017). Monaghan's term
/// acts on the whole v_ij.r_ij of approaching pairs, so that it resists smooth shear as a viscosity of about
/// rho alpha c_s h/8 would, which falls with the spacing and decides how far a slide runs. In smooth shear J is the
/// error of the strain rates, a small part of S, and its fourth power removes it; where particles shake, S is small and
/// v_ij.r_ij counts whole. Both signs count: damping of approaching pairs alone is a pressure, which lifts a sheared
/// layer and drives its toe outwards. The term never feeds energy, since w lies between 0 and 1. Why 4 S^2: README.md.
/// `Quadratic`: beta is not zero.
template <class Real, bool Quadratic>
struct ReconstructedViscosity {
  Real alpha_c;      ///< alpha c_s [m/s]
  Real beta_h2;      ///< beta h^2
  Real half_h2;      ///< -h^2/2, times alpha c_s where the law is linear
  Real per_h, soft;  ///< 1/h, and 0.01 h^2, in the unit of the distances

  /// @param unit  of the distances [m]
  HWY_INLINE ReconstructedViscosity(const FlowConstants& k, double unit)
      : alpha_c(k.numerics.alpha * k.c_s),
        beta_h2(k.numerics.beta * k.h * k.h / (unit * unit)),
        half_h2((Quadratic ? -0.5 : -0.5 * k.numerics.alpha * k.c_s) * k.h * k.h / (unit * unit)),
        per_h(unit / k.h),
        soft(0.01 * k.h * k.h / (unit * unit)) {}

  /// What all pairs of a particle i have in common.
  HWY_INLINE Real of_particle(Real rho_i) const { return half_h2 * rho_i; }

  /// rho_i rho_j Pi_ij
  /// @param v_dot_r       v_ij.r_ij
  /// @param twice_smooth  2 S/h [m/s]: over h, so that in single precision the fourth power stays in range
  HWY_INLINE Real operator()(Real of_i, Real rho_j, Real v_dot_r, Real twice_smooth, Real r2) const {
    const Real least2(1e-18);  // all counts below 1e-9 m/s
    const Real v = v_dot_r * per_h, left = fnma(Real(0.5), twice_smooth, v);
    const Real left2 = fma(left, left, least2), all2 = fma(twice_smooth, twice_smooth, left2);
    const Real w_r2 = (left2 * left2) / (all2 * all2 * (r2 + soft));
    const Real linear = fma(half_h2, rho_j, of_i) * v * w_r2;
    if constexpr (!Quadratic) return linear;
    return linear * fma(beta_h2, abs(v) * w_r2, alpha_c);
  }
};

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

/// Calls run<Quadratic, Reconstruct>() for the options of the artificial viscosity.
template <class Run>
HWY_INLINE void with_artificial_viscosity(const Numerics& n, Run&& run) {
  const bool quadratic = n.beta > 0.0, reconstruct = n.velocity_jump == VelocityJump::reconstructed;
  if (quadratic && reconstruct)
    run.template operator()<true, true>();
  else if (quadratic)
    run.template operator()<true, false>();
  else if (reconstruct)
    run.template operator()<false, true>();
  else
    run.template operator()<false, false>();
}

/// What a soil-wall pair adds to the momentum equation besides the stress.
template <class Real>
struct WallTerm {
  Real Pi;            ///< rho_i rho_j Pi_ij [Pa]
  Real VF;            ///< volume of the wall particle times the kernel's -F
  Vector<Real> v_ij;  ///< relative velocity [m/s]
  Vector<Real> arm;   ///< the part of r_ij along which the artificial viscosity acts
};

/// What all soil-wall pairs of a run have in common in the momentum equation.
/// `Quadratic`: beta is not zero. `Reconstruct`: VelocityJump::reconstructed.
template <class Real, bool Quadratic, bool Reconstruct>
struct WallForce {
  WallLaw<Real> wall;
  ArtificialViscosity<Real, Quadratic> viscosity;
  Real volume;  ///< of a wall particle [m2]

  /// @param unit  of the distances [m]
  HWY_INLINE WallForce(const FlowConstants& k, double unit) : wall(k, unit), viscosity(k, unit), volume(k.dx * k.dx) {}

  /// @param of_i    viscosity.of_particle(rho_i)
  /// @param kernel  -F over its normalisation; @param r, r2  separation r_ij and its square
  HWY_INLINE WallTerm<Real> term(Real of_i, Real rho_i, Vector<Real> v_i, const WallParticle<Real>& j, Real kernel,
                                 Vector<Real> r, Real r2) const {
    const WallPair<Real> w = wall.pair(r, v_i, j);
    Real VF = volume * kernel;
    if (wall.only_approaching) VF = select_or_zero(w.v_dot_r < Real(0.0), VF);
    const Vector<Real> arm = Reconstruct ? across_wall(r, j.normal) : r;
    const Real approach = min(Reconstruct ? dot(w.v_ij, arm) : w.v_dot_r, Real(0.0));
    return {viscosity(of_i, rho_i, rho_i, approach, r2), VF, w.v_ij, arm};
  }
  /// Adds the term to the sum of add_force(). @param s_w  stress extrapolated to the wall particle [Pa]
  HWY_INLINE Vector<Real> add(Vector<Real> sum, Symmetric<Real> s_i, Symmetric<Real> s_w, const WallTerm<Real>& term,
                              Vector<Real> r) const {
    return Reconstruct ? add_force(sum, s_i, s_w, term.Pi, term.VF, r, term.arm)
                       : add_force(sum, s_i, s_w, term.Pi, term.VF, r);
  }
};

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

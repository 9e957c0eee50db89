// Velocity gradient, continuity and diffusion of density (delta-SPH), and the stress that follows, for every number
// type. Included once for every instruction set.

#if defined(TALUS_SPH_CONTINUITY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_CONTINUITY_INL
#undef TALUS_SPH_CONTINUITY_INL
#else
#define TALUS_SPH_CONTINUITY_INL
#endif

#include <hwy/highway.h>

#include "material/constitutive_models-inl.hpp"
#include "math/tensor-inl.hpp"
#include "sph/energy-inl.hpp"
#include "sph/flow_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// L_i = sum_j V_j (v_j - v_i) (x) grad_i W_ij, V_j = m_j/rho_j               [Z20] Eq. 9
/// Adds the term of one neighbour, grad_i W_ij = F r_ij. The paper prints v_i - v_j, which is minus the velocity
/// gradient and would make Eq. 10 anti-viscous.
template <class Real>
HWY_INLINE void add_velocity_gradient(Gradient<Real>& L, Vector<Real> VF_v_ij, Vector<Real> r_ij) {
  L.xx = fnma(VF_v_ij.x, r_ij.x, L.xx);
  L.xy = fnma(VF_v_ij.x, r_ij.y, L.xy);
  L.yx = fnma(VF_v_ij.y, r_ij.x, L.yx);
  L.yy = fnma(VF_v_ij.y, r_ij.y, L.yy);
}

/// Density of a particle in all pair sums, V = m/rho: its own, but at least a quarter of rho0.
/// Loose soil has no pressure to keep its density up (apply_tension_cutoff). With V = m/rho alone, particles that fly
/// apart would reach rho = 0 and V without bound in finite time; with V bounded, their density decays and never
/// vanishes. m = rho V stays, so that pairs conserve momentum.
/// @param least  least_density(rho0)
template <class Real>
HWY_INLINE Real pair_density(Real rho, Real least) {
  return max(rho, least);
}
HWY_INLINE double least_density(double rho0) { return 0.25 * rho0; }

/// drho_i/dt = sum_j m_j (v_i - v_j) . grad_i W_ij                          [Z20] Eq. 1
/// Adds the term of one neighbour, m_j = rho_j V_j. With rho_i instead of rho_j it is the volume form (Colagrossi &
/// Landrini 2003), which is the same where the density is uniform and stays right across the layers of a slide; that
/// form is -rho_i tr(L_i) and needs no sum of its own.
template <class Real>
HWY_INLINE Real add_continuity(Real drho, Real rho_j, Vector<Real> VF_v_ij, Vector<Real> r_ij) {
  return fma(rho_j, dot(VF_v_ij, r_ij), drho);
}

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

/// What the neighbours of a particle do to its density and deformation.
template <class Real>
struct FlowRates {
  Gradient<Real> L;  ///< velocity gradient [1/s]
  Real expansion;    ///< -(drho/dt)/rho without diffusion [1/s]
  Real diffusion;    ///< rate of rho/rho0 by delta-SPH [1/s]
};

/// Sums over the neighbours, with -F h^2/sigma for F.
template <class Real>
struct FlowRateSums {
  Gradient<Real> L;
  Real drho;       ///< of the mass form, [Z20] Eq. 1
  Real diffusion;  ///< of delta-SPH

  static HWY_INLINE FlowRateSums zero() {
    const Real zero(0.0);
    return {{zero, zero, zero, zero}, zero, zero};
  }

  /// Adds one neighbour, soil or wall; `by_mass`: [Z20] Eq. 1 as printed, not the volume form.
  HWY_INLINE void add(Real VF, Real rho_j, Vector<Real> v_ij, Vector<Real> r_ij, bool by_mass) {
    const Vector<Real> VF_v_ij = VF * v_ij;
    add_velocity_gradient(L, VF_v_ij, r_ij);
    if (by_mass) drho = add_continuity(drho, rho_j, VF_v_ij, r_ij);
  }

  /// @param to_L          -sigma/h^2 in the unit of the distances
  /// @param to_diffusion  2 delta h c_s sigma/h^2
  HWY_INLINE FlowRates<Real> rates(Real to_L, Real to_diffusion, bool by_mass, Real rho) const {
    const Gradient<Real> scaled{to_L * L.xx, to_L * L.xy, to_L * L.yx, to_L * L.yy};
    const Real expansion = by_mass ? (Real(0.0) - to_L * drho) / rho : trace(scaled);
    return {scaled, expansion, to_diffusion * diffusion};
  }
};

/// Viscosity of a point once it has yielded: that of its material, or its own, or that of mu(I).
/// @param at  as in update_point
template <class Real, class Point>
HWY_INLINE Real yielded_viscosity(const Point& at, Real p, Real gamma_dot) {
  using Parameters = const ConstitutiveParameters&;
  const Real eta = at.viscosity();
  const Real d = at.constant([](Parameters soil) { return soil.mu_i.d; });
  if (!any(d > Real(0.0))) return eta;
  const InertialFriction<Real> mu_i{.delta_mu = at.constant([](Parameters soil) { return soil.mu_i.delta_mu; }),
                                    .I_0 = at.constant([](Parameters soil) { return soil.mu_i.I_0; }),
                                    .mu_inf = at.constant([](Parameters soil) { return soil.mu_i.mu_inf; }),
                                    .d = d,
                                    .rho_s = at.constant([](Parameters soil) { return soil.mu_i.rho_s; })};
  return eta + inertial_viscosity(mu_i, p, gamma_dot);
}

/// Pressure of a point [Pa]. @param at  as in update_point
template <class Point>
HWY_INLINE auto pressure_of(const FlowConstants& k, const Point& at) {
  const auto p = pressure(at.constant([](const ConstitutiveParameters& soil) { return soil.eos.B; }), at.q());
  return k.numerics.tension_cutoff ? apply_tension_cutoff(p) : p;
}

/// Pressure, stress, and the rates of density and elastic stress.                [Z20] Eqs. 1, 3-10
/// @param strength  of the soil, or of the wall that it slides along
/// @param at        the point, or the points of a cluster: q(), reference_density(), viscosity(), constant(get) of its
///                  ConstitutiveParameters; elastic() as the model needs it; set_strain_rate(e), set_stress(s, p),
///                  set_rates(drho, gamma_dot); set_powers(f), which calls f(volume) for StressPowers where an
///                  evaluation measures them
template <class Real, class Model, class Point>
HWY_INLINE void update_point(const FlowConstants& k, const Model& model, const FlowRates<Real>& rates,
                             const MohrCoulomb<Real>& strength, Point&& at) {
  using Parameters = const ConstitutiveParameters&;
  const Real q = at.q();
  Real p = pressure(at.constant([](Parameters soil) { return soil.eos.B; }), q);
  if (k.numerics.tension_cutoff) p = apply_tension_cutoff(p);
  at.set_strain_rate(strain_rate(rates.L));
  const Deviator<Real> e = deviatoric_strain_rate(rates.L);
  const Real gamma_dot = shear_rate(e, k.rheology.shear_rate);
  const PointState<Real> state{.e = e,
                               .two_spin = two_spin(rates.L),
                               .gamma_dot = gamma_dot,
                               .p = p,
                               .c = strength.c,
                               .tan_phi = strength.tan_phi,
                               .eta = yielded_viscosity(at, p, gamma_dot),
                               .two_G = at.constant([](Parameters soil) { return 2.0 * soil.G; })};
  const Deviator<Real> t = model.stress(state, at.elastic());
  at.set_stress(cauchy(p, t), p);
  // drho/dt = -rho expansion + rho0 diffusion
  const Real rho0 = at.reference_density();
  at.set_rates(rho0 * fnma(q + Real(1.0), rates.expansion, rates.diffusion), gamma_dot);
  at.set_powers([&](Real V) HWY_ATTR {
    return stress_powers(V, p, t, e, state.eta, trace(rates.L), rates.expansion, rates.diffusion, q);
  });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

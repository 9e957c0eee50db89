// Equation of state, yield stress and the constitutive models that a run can choose, for every number type. Included
// once for every instruction set.

#if defined(TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL
#undef TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL
#else
#define TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL
#endif

#include <hwy/highway.h>

#include <numbers>
#include <type_traits>

#include "material/equation_of_state.hpp"
#include "material/material.hpp"
#include "math/tensor-inl.hpp"

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

/// gamma_dot = sqrt(2 dev(e):dev(e)): simple shear v_x(y) gives |dv_x/dy|, as Eq. 5 needs.
/// ShearRate::paper: sqrt(2/3 dev(e):dev(e)), [Z20] Eq. 7 as printed; the yielded stress comes out sqrt(3) times
/// larger.
template <class Real>
HWY_INLINE Real shear_rate(Deviator<Real> e, ShearRate norm) {
  return sqrt(Real(norm == ShearRate::paper ? 2.0 / 3.0 : 2.0) * double_dot(e));
}

/// On tau_y: the norm of Eq. 7 as printed shears at sqrt(3) tau_y, and the elastic law follows it.
inline double yield_factor(ShearRate norm) { return norm == ShearRate::paper ? std::numbers::sqrt3 : 1.0; }

/// Strength of a point.
template <class Real>
struct MohrCoulomb {
  Real c;        ///< cohesion [Pa]
  Real tan_phi;  ///< tangent of the friction angle [-]
};

/// tau_y = c + max(p, 0) tan(phi)                                          [Z20] Eq. 5
template <class Real>
HWY_INLINE Real yield_stress(Real c, Real tan_phi, Real p) {
  return fma(max(p, Real(0.0)), tan_phi, c);
}

/// mu(I) = mu_s + (delta_mu I + mu_inf I^2)/(I_0 + I), I = gamma_dot d sqrt(rho_s/p)
/// Jop, Forterre & Pouliquen 2006 (Nature 441) with mu_inf = 0; Barker & Gray 2017 (J. Fluid Mech. 828) with the last
/// term.
///
/// The yield stress carries p mu_s. The rest, p (mu(I) - mu_s) = eta gamma_dot, is this viscosity:
///   eta = s d (delta_mu + mu_inf I)/(I_0 + I),  I = gamma_dot d rho_s/s,  s = sqrt(p rho_s)
/// multiplied out, so that soil without pressure, or at rest, divides nothing by zero. It is zero without pressure.
///
/// Incompressible and rigid below the yield stress, the law of Jop et al. is ill posed at low and at high I (Barker et
/// al. 2015, J. Fluid Mech. 779). At high I the slope mu_inf is the cure of Barker & Gray. At low I theirs is a curve
/// that falls to zero with I, which leaves no yield stress and lets every slope creep. It is not needed here: pressure
/// and yield stress follow from the density and the elastic stress, which are integrals of the velocity gradient over
/// time, so that only this viscosity acts on the present one, and p (mu(I) - mu_s) grows with the shear rate everywhere
/// (on compressibility as a cure: Heyman et al. 2017, J. Fluid Mech. 830).
template <class Real>
HWY_INLINE Real inertial_viscosity(const InertialFriction<Real>& of, Real p, Real gamma_dot) {
  const Real s = sqrt(max(p, Real(0.0)) * of.rho_s), Is = gamma_dot * of.d * of.rho_s;
  return s * of.d * fma(of.mu_inf, Is, of.delta_mu * s) / max(fma(of.I_0, s, Is), Real(1e-30));
}

/// What a constitutive model is told of a point.
template <class Real>
struct PointState {
  Deviator<Real> e;  ///< deviatoric strain rate [1/s]
  Real two_spin;     ///< 2 omega_xy [1/s]
  Real gamma_dot;    ///< shear rate [1/s]
  Real p;            ///< pressure [Pa]
  Real c;            ///< cohesion [Pa]
  Real tan_phi;      ///< tangent of the friction angle [-]
  Real eta;          ///< viscosity once it has yielded, that of mu(I) included [Pa s]
  Real two_G;        ///< twice the numerical shear modulus [Pa]
};

/// Regularised Bingham: an equivalent viscosity, large but finite where the soil does not yield, so that it creeps.
template <class Real>
struct RegularisedBingham {
  Real gamma_dot_min;  ///< floor of the shear rate [1/s], > 0

  explicit HWY_INLINE RegularisedBingham(const Rheology& rheology) : gamma_dot_min(rheology.gamma_dot_min) {}

  /// eta' = eta + tau_y / max(gamma_dot, gamma_dot_min)                    [Z20] Eq. 6
  HWY_INLINE Real viscosity(Real eta, Real tau_y, Real gamma_dot) const {
    return eta + tau_y / max(gamma_dot, gamma_dot_min);
  }
  /// t = 2 eta' dev(e)                                                     [Z20] Eq. 10, deviator written out
  template <class ElasticStress>
  HWY_INLINE Deviator<Real> stress(const PointState<Real>& at, ElasticStress&&) const {
    const Real zero(0.0), tau_y = yield_stress(at.c, at.tan_phi, at.p);
    const Real eta = viscosity(at.eta, tau_y, at.gamma_dot);
    return fma(eta + eta, at.e, Deviator<Real>{zero, zero, zero});
  }
};

/// dt/dt = omega t - t omega + 2 G dev(e): elastic rate with the Jaumann spin terms, so that a rigid rotation turns the
/// stress without changing it.
template <class Real>
HWY_INLINE Deviator<Real> elastic_rate(Deviator<Real> t, Deviator<Real> e, Real two_spin, Real two_G) {
  const Real turn = two_spin * t.xy;
  return {fma(two_G, e.xx, turn), fms(two_G, e.yy, turn), fma(two_G, e.xy, Real(0.5) * two_spin * (t.yy - t.xx))};
}

/// Elasto-viscoplastic: rigid below the yield stress up to a numerical elasticity, viscous beyond; no creep at rest.
template <class Real>
struct ElastoViscoplastic {
  Real of_yield;  ///< yield_factor

  explicit HWY_INLINE ElastoViscoplastic(const Rheology& rheology) : of_yield(yield_factor(rheology.shear_rate)) {}

  /// t = t_elastic + 2 eta dev(e)
  /// @param elastic  the stress that the soil keeps: value(), add(change) and set_rate(dt/dt)
  template <class ElasticStress>
  HWY_INLINE Deviator<Real> stress(const PointState<Real>& at, ElasticStress&& elastic) const {
    Deviator<Real> t = elastic.value();
    const Real limit = of_yield * yield_stress(at.c, at.tan_phi, at.p), size = magnitude(t);
    if (const auto yields = size > limit; any(yields)) {
      const Deviator<Real> change = t * select_or_zero(yields, limit / size - Real(1.0));
      t = t + change;
      elastic.add(change);
    }
    elastic.set_rate(elastic_rate(t, at.e, at.two_spin, at.two_G));
    return fma(at.eta + at.eta, at.e, t);
  }
};

/// Calls f(std::type_identity of the model's type). A model is constructed from Rheology and has
/// stress(PointState, elastic stress).
template <class Real, class F>
void with_constitutive_model(const Rheology& rheology, F&& f) {
  if (rheology.yield == Yield::regularized)
    f(std::type_identity<RegularisedBingham<Real>>());
  else
    f(std::type_identity<ElastoViscoplastic<Real>>());
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

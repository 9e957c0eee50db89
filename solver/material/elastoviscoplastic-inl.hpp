// The elasto-viscoplastic model for every number type: rigid below the yield stress up to a numerical elasticity, no
// creep at rest. Included once for every instruction set.

#if defined(TALUS_MATERIAL_ELASTOVISCOPLASTIC_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_MATERIAL_ELASTOVISCOPLASTIC_INL
#undef TALUS_MATERIAL_ELASTOVISCOPLASTIC_INL
#else
#define TALUS_MATERIAL_ELASTOVISCOPLASTIC_INL
#endif

#include <hwy/highway.h>

#include <numbers>

#include "material/bingham-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// dt/dt = omega t - t omega + 2 G dev(e): elastic rate with the Jaumann spin terms, so that a rigid rotation turns the
/// stress without changing it.
template <class Real>
HWY_INLINE Deviator<Real> elastic_rate(Deviator<Real> t, Deviator<Real> e, Real two_spin, Real two_G) {
  const Real turn = two_spin * t.xy;
  return {fma(two_G, e.xx, turn), fms(two_G, e.yy, turn), fma(two_G, e.xy, Real(0.5) * two_spin * (t.yy - t.xx))};
}

/// Elastic up to the yield stress, viscous beyond.
template <class Real>
struct ElastoViscoplastic {
  Real
      yield_factor;  ///< on tau_y: the norm of Eq. 7 as printed shears at sqrt(3) tau_y, and the elastic law follows it

  explicit HWY_INLINE ElastoViscoplastic(const Rheology& rheology)
      : yield_factor(rheology.shear_rate == ShearRate::paper ? std::numbers::sqrt3 : 1.0) {}

  /// t = t_elastic + 2 eta dev(e)
  /// @param elastic  the stress that the soil keeps: value(), add(change) and set_rate(dt/dt)
  template <class ElasticStress>
  HWY_INLINE Deviator<Real> stress(const PointState<Real>& at, ElasticStress&& elastic) const {
    Deviator<Real> t = elastic.value();
    const Real limit = yield_factor * at.tau_y, size = magnitude(t);
    if (const auto yields = size > limit; any(yields)) {
      const Deviator<Real> change = t * select_or_zero(yields, limit / size - Real(1.0));
      t = t + change;
      elastic.add(change);
    }
    elastic.set_rate(elastic_rate(t, at.e, at.two_spin, at.two_G));
    return fma(at.eta + at.eta, at.e, t);
  }
};

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

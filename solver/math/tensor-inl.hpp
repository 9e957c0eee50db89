// Trace, deviator, magnitude: written here and nowhere else. Included once for every instruction set.

#if defined(TALUS_MATH_TENSOR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_MATH_TENSOR_INL
#undef TALUS_MATH_TENSOR_INL
#else
#define TALUS_MATH_TENSOR_INL
#endif

#include <hwy/highway.h>

#include "math/number.hpp"
#include "math/tensor.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

using talus::fma, talus::select;  // beside those of vectors and tensors

template <class Real>
HWY_INLINE Vector<Real> operator-(Vector<Real> a, Vector<Real> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class Real>
HWY_INLINE Vector<Real> operator*(Real s, Vector<Real> a) {
  return {s * a.x, s * a.y};
}
template <class Real>
HWY_INLINE Real dot(Vector<Real> a, Vector<Real> b) {
  return fma(a.x, b.x, a.y * b.y);
}
/// a s + b
template <class Real>
HWY_INLINE Vector<Real> fma(Real s, Vector<Real> a, Vector<Real> b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y)};
}

template <class Real>
HWY_INLINE Symmetric<Real> operator+(Symmetric<Real> a, Symmetric<Real> b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
}
template <class Mask, class Real>
HWY_INLINE Symmetric<Real> select(Mask where, Symmetric<Real> a, Symmetric<Real> b) {
  return {select(where, a.xx, b.xx), select(where, a.yy, b.yy), select(where, a.xy, b.xy)};
}
template <class Real>
HWY_INLINE Vector<Real> operator*(Symmetric<Real> a, Vector<Real> v) {
  return {fma(a.xx, v.x, a.xy * v.y), fma(a.xy, v.x, a.yy * v.y)};
}

template <class Real>
HWY_INLINE Symmetric<Real> operator*(Real s, Symmetric<Real> a) {
  return {s * a.xx, s * a.yy, s * a.xy};
}

template <class Real>
HWY_INLINE Deviator<Real> operator+(Deviator<Real> a, Deviator<Real> b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
}
template <class Real>
HWY_INLINE Deviator<Real> operator*(Deviator<Real> a, Real s) {
  return {a.xx * s, a.yy * s, a.xy * s};
}
template <class Real>
HWY_INLINE Deviator<Real> fma(Real s, Deviator<Real> a, Deviator<Real> b) {
  return {fma(s, a.xx, b.xx), fma(s, a.yy, b.yy), fma(s, a.xy, b.xy)};
}

template <class Real>
HWY_INLINE Real trace(Gradient<Real> L) {
  return L.xx + L.yy;
}
/// 2 omega_xy of omega = (L - L^T)/2.
template <class Real>
HWY_INLINE Real two_spin(Gradient<Real> L) {
  return L.xy - L.yx;
}
/// e = (L + L^T)/2                                                            [Z20] Eq. 9
template <class Real>
HWY_INLINE Symmetric<Real> strain_rate(Gradient<Real> L) {
  return {L.xx, L.yy, Real(0.5) * (L.xy + L.yx)};
}
/// dev(e) = e - tr(e)/3 I with the 3D trace, e = (L + L^T)/2                 [Z20] Eqs. 8, 9
/// L has the sign of v_j - v_i; the e of the printed Eq. 9 is minus the strain rate.
template <class Real>
HWY_INLINE Deviator<Real> deviatoric_strain_rate(Gradient<Real> L) {
  const Real third(1.0 / 3.0), tr = trace(L);
  return {fnma(third, tr, L.xx), fnma(third, tr, L.yy), Real(0.5) * (L.xy + L.yx)};
}

/// a:b over all nine components.
template <class Real>
HWY_INLINE Real double_dot(Deviator<Real> a, Deviator<Real> b) {
  return fma(a.xx, b.xx, fma(a.yy, b.yy, fma(a.xx + a.yy, b.xx + b.yy, Real(2.0) * (a.xy * b.xy))));
}
/// d:d over all nine components.
template <class Real>
HWY_INLINE Real double_dot(Deviator<Real> d) {
  return double_dot(d, d);
}
/// sqrt(t:t/2): the shear stress of simple shear.
template <class Real>
HWY_INLINE Real magnitude(Deviator<Real> t) {
  return sqrt(Real(0.5) * double_dot(t));
}

/// sigma = -p I + t.
template <class Real>
HWY_INLINE Symmetric<Real> cauchy(Real p, Deviator<Real> t) {
  return {t.xx - p, t.yy - p, t.xy};
}

/// Shear of s on the plane of unit normal n: t.s.n, t = (-n_y, n_x).
template <class Real>
HWY_INLINE Real shear_on(Symmetric<Real> s, Vector<Real> n) {
  const Vector<Real> s_n = s * n;
  return fms(n.x, s_n.y, n.y * s_n.x);
}
/// s with `change` added to that shear: s + change (t n^T + n t^T).
template <class Real>
HWY_INLINE Symmetric<Real> add_shear(Symmetric<Real> s, Vector<Real> n, Real change) {
  const Real xx = (change * Real(2.0)) * (n.x * n.y);
  return {s.xx - xx, s.yy + xx, fma(change, fms(n.x, n.x, n.y * n.y), s.xy)};
}
/// s with that shear reversed, as a frictionless wall mirrors it.
template <class Real>
HWY_INLINE Symmetric<Real> mirrored(Symmetric<Real> s, Vector<Real> n) {
  return add_shear(s, n, Real(-2.0) * shear_on(s, n));
}
/// s with that shear taken back to at most `limit` >= 0.
template <class Real>
HWY_INLINE Symmetric<Real> with_bounded_shear(Symmetric<Real> s, Vector<Real> n, Real limit) {
  const Real shear = shear_on(s, n);
  return add_shear(s, n, min(max(shear, Real(0.0) - limit), limit) - shear);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Smoothing kernels of support 2h in two dimensions, for every number type. Included once for every instruction set.
//
// W(r) [1/m2] and F(r) = W'(r)/r [1/m4], so that grad_i W_ij = F r_ij. Both come without their normalisation sigma,
// which sums are multiplied by at their end: W/sigma, and -F h^2/sigma. Both vanish beyond 2h of themselves.

#if defined(TALUS_SPH_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_KERNEL_INL
#undef TALUS_SPH_KERNEL_INL
#else
#define TALUS_SPH_KERNEL_INL
#endif

#include <hwy/highway.h>

#include <cmath>
#include <numbers>
#include <type_traits>

#include "math/number.hpp"
#include "sph/flow_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Cubic B-spline, Monaghan & Lattanzio 1985: sigma (2/3 - u^2 + u^3/2) for u < 1, sigma/6 (2 - u)^3 for u < 2,
/// sigma = 15/(7 pi h^2), u = r/h.
template <class Real>
struct CubicSpline {
  static constexpr double normalisation = 15.0 / 7.0;  ///< sigma pi h^2
  Real per_h, inner_slope, h2, outer_scale, edge;

  /// @param unit_per_h  1/h in the unit of the distances
  explicit HWY_INLINE CubicSpline(double unit_per_h)
      : per_h(unit_per_h),
        inner_slope(1.5 * unit_per_h),
        h2(1.0 / (unit_per_h * unit_per_h)),
        outer_scale(std::sqrt(0.5 * unit_per_h)),
        edge(std::sqrt(2.0 / unit_per_h)) {}

  /// -F h^2/sigma = 2 - 3/2 u for u < 1, (2 - u)^2/(2u) beyond. At r = 0 the second is infinite and not chosen.
  HWY_INLINE Real minus_F(Real r, Real r2) const {
    const Real w = max(fnma(outer_scale, r, edge), Real(0.0));
    return select(r2 < h2, fnma(inner_slope, r, Real(2.0)), w * w / r);
  }
  HWY_INLINE Real W(Real r) const {
    const Real u = per_h * r, w = max(Real(2.0) - u, Real(0.0));
    const Real inner = fma(u * u, fms(Real(0.5), u, Real(1.0)), Real(2.0 / 3.0));
    return select(u < Real(1.0), inner, w * w * (w * Real(1.0 / 6.0)));
  }
};

/// Wendland C2 (Wendland 1995): sigma (1 - u/2)^4 (2u + 1), sigma = 7/(4 pi h^2), u = r/h < 2.
template <class Real>
struct WendlandC2 {
  static constexpr double normalisation = 7.0 / 4.0;  ///< sigma pi h^2
  Real half_per_h;

  /// @param unit_per_h  1/h in the unit of the distances
  explicit HWY_INLINE WendlandC2(double unit_per_h) : half_per_h(0.5 * unit_per_h) {}

  /// w = 1 - u/2 inside the support.
  HWY_INLINE Real inside(Real r) const { return max(fnma(half_per_h, r, Real(1.0)), Real(0.0)); }

  /// -F h^2/sigma = 5 w^3
  HWY_INLINE Real minus_F(Real r, Real) const {
    const Real w = inside(r);
    return Real(5.0) * w * (w * w);
  }
  /// W/sigma = w^4 (2u + 1) = w^4 (5 - 4w)
  HWY_INLINE Real W(Real r) const {
    const Real w = inside(r), w2 = w * w;
    return w2 * w2 * fnma(Real(4.0), w, Real(5.0));
  }
};

/// Calls f(std::type_identity of the kernel's type).
template <class Real, class F>
void with_kernel(KernelShape shape, F&& f) {
  if (shape == KernelShape::wendland_c2)
    f(std::type_identity<WendlandC2<Real>>());
  else
    f(std::type_identity<CubicSpline<Real>>());
}

/// sigma/h^2 [1/m4]
template <class Kernel>
inline double sigma_h2(double h) {
  const double h2 = h * h;
  return Kernel::normalisation / (std::numbers::pi * h2 * h2);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

#pragma once
// The Bingham fluid that truly yields: rigid below the yield stress up to a numerical elasticity, no creep at rest.

#include "math/tensor.hpp"

namespace talus {

/// dt/dt = omega t - t omega + 2 G dev(e): elastic rate with the Jaumann spin terms, so that a rigid rotation turns the
/// stress without changing it. `spin` is omega_xy [1/s], G the numerical shear modulus [Pa].
constexpr Dev elastic_rate(Dev t, Dev e, double spin, double G) {
  return {2.0 * spin * t.xy + 2.0 * G * e.xx, -2.0 * spin * t.xy + 2.0 * G * e.yy,
          spin * (t.yy - t.xx) + 2.0 * G * e.xy};
}

/// Scales t back to the yield surface: sqrt(t:t/2) <= tau_y.
inline Dev return_to_yield(Dev t, double tau_y) {
  const double size = magnitude(t);
  return size > tau_y ? (tau_y / size) * t : t;
}

}  // namespace talus

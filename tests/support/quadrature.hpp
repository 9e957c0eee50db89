#pragma once
// Integrals of functions of one variable.

#include <boost/math/quadrature/gauss.hpp>

namespace talus {

/// Integral of f over [lo, hi] by 15-point Gauss-Legendre quadrature on `panels` equal panels; exact for polynomials of
/// degree 29. Split the interval at kinks of f.
template <class F>
double integrate(F&& f, double lo, double hi, int panels = 1) {
  const double width = (hi - lo) / panels;
  double sum = 0;
  for (int k = 0; k < panels; ++k)
    sum += boost::math::quadrature::gauss<double, 15>::integrate(f, lo + k * width, lo + (k + 1) * width);
  return sum;
}

}  // namespace talus

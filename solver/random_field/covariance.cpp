#include "random_field/covariance.hpp"

#include <cmath>

namespace talus {

// With G'' = exp(-|s|/ell), G = ell |s| + ell^2 exp(-|s|/ell), the average is (G(d+h) - 2 G(d) + G(d-h)) / h^2. The
// straight parts of G cancel for d >= h; what is left of the exponentials is a sinh.
double ExponentialCovariance::operator()(double d) const {
  d = std::abs(d);
  const double h = cell;
  if (h == 0) return std::exp(-d / ell);
  if (d >= h) {
    const double s = std::sinh(h / (2 * ell)) * 2 * ell / h;
    return s * s * std::exp(-d / ell);
  }
  const double straight = 2 * (h - d) / ell;
  const double curved = std::exp(-(d + h) / ell) - 2 * std::exp(-d / ell) + std::exp(-(h - d) / ell);
  return (ell / h) * (ell / h) * (straight + curved);
}

}  // namespace talus

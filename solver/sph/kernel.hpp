#pragma once
// Smoothing kernels of support 2h in two dimensions. W(r) [1/m2] and F(r) = W'(r)/r [1/m4], so that grad_i W_ij = F
// r_ij.

#include <cmath>
#include <numbers>

#include "math/vec2.hpp"

namespace talus {

/// Cubic B-spline, Monaghan & Lattanzio 1985: sigma (2/3 - q^2 + q^3/2) for q < 1, sigma/6 (2 - q)^3 for q < 2,
/// sigma = 15/(7 pi h^2), q = r/h.
struct CubicSpline {
  double h;  ///< smoothing length [m], > 0
  double inverse_h = 1.0 / h;
  double sigma = 15.0 / (7.0 * std::numbers::pi * h * h);
  double sigma_h2 = sigma / (h * h);

  double support2() const { return 4.0 * h * h; }
  double W(double r2) const {
    const double q = std::sqrt(r2) * inverse_h;
    if (q < 1.0) return sigma * (2.0 / 3.0 - q * q + 0.5 * q * q * q);
    const double u = 2.0 - q;
    return u > 0.0 ? sigma / 6.0 * u * u * u : 0.0;
  }
  double F(double r2) const {
    const double q = std::sqrt(r2) * inverse_h;
    if (q < 1.0) return sigma_h2 * (1.5 * q - 2.0);
    const double u = 2.0 - q;
    return u > 0.0 ? -0.5 * sigma_h2 * u * u / q : 0.0;
  }
};

/// Wendland C2 (Wendland 1995): sigma (1 - q/2)^4 (2q + 1), sigma = 7/(4 pi h^2), q = r/h < 2.
struct WendlandC2 {
  double h;  ///< smoothing length [m], > 0
  double inverse_h = 1.0 / h;
  double sigma = 7.0 / (4.0 * std::numbers::pi * h * h);
  double sigma_h2 = sigma / (h * h);

  double support2() const { return 4.0 * h * h; }
  double W(double r2) const {
    const double q = std::sqrt(r2) * inverse_h, u = 1.0 - 0.5 * q;
    return u > 0.0 ? sigma * u * u * u * u * (2.0 * q + 1.0) : 0.0;
  }
  double F(double r2) const {
    const double u = 1.0 - 0.5 * std::sqrt(r2) * inverse_h;
    return u > 0.0 ? -5.0 * sigma_h2 * u * u * u : 0.0;
  }
};

}  // namespace talus

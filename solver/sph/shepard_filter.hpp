#pragma once
// "Regularized correction of density" ([Z20] 2.1) by the Shepard filter. It runs every few steps only, in double
// precision beside both kinds of loops, and on kernels with their normalisation: other products would round
// differently, and results are to stay the same bit for bit.

#include <cmath>
#include <numbers>

#include "sph/numerics.hpp"

namespace talus {

/// W [1/m2] of the kernels in kernel-inl.hpp, in double precision.
struct ShepardKernel {
  KernelShape shape;
  double inverse_h;  ///< [1/m]
  double sigma;      ///< normalisation [1/m2]

  /// @param h  smoothing length [m], > 0
  ShepardKernel(KernelShape kernel, double h)
      : shape(kernel),
        inverse_h(1.0 / h),
        sigma(kernel == KernelShape::wendland_c2 ? 7.0 / (4.0 * std::numbers::pi * h * h)
                                                 : 15.0 / (7.0 * std::numbers::pi * h * h)) {}

  /// @param r2  squared distance [m2]
  double W(double r2) const {
    const double u = std::sqrt(r2) * inverse_h;
    if (shape == KernelShape::wendland_c2) {
      const double w = 1.0 - 0.5 * u;
      return w > 0.0 ? sigma * w * w * w * w * (2.0 * u + 1.0) : 0.0;
    }
    if (u < 1.0) return sigma * (2.0 / 3.0 - u * u + 0.5 * u * u * u);
    const double w = 2.0 - u;
    return w > 0.0 ? sigma / 6.0 * w * w * w : 0.0;
  }
};

/// rho_i/rho0_i <- sum_j V_j q_j W_ij / sum_j V_j W_ij with q = rho/rho0, itself included.
/// For one material this is sum m_j W_ij / sum V_j W_ij.
struct ShepardSum {
  double weighted = 0.0, weight = 0.0;

  void add(double V_j, double q_j, double W) {
    weighted += V_j * q_j * W;
    weight += V_j * W;
  }
  double value() const { return weighted / weight; }
};

}  // namespace talus

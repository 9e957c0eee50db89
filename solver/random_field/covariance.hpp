#pragma once
// Covariance of a field along one axis. A two-dimensional covariance is the product of two of these.

namespace talus {

/// C(d) = exp(-|d| / ell), or the covariance of that field's moving average over `cell`:
/// C(d) = (1/h^2) integral_{-h}^{h} (h - |s|) exp(-|d + s| / ell) ds with h = cell (Vanmarcke 1983).
struct ExponentialCovariance {
  double ell;         ///< correlation length [m], > 0
  double cell = 0.0;  ///< length that the field is averaged over [m]; 0: the field at a point

  /// @param d  lag [m]
  double operator()(double d) const;
};

}  // namespace talus

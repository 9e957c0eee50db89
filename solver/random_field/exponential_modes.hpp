#pragma once
// Eigenpairs of the exponential covariance on an interval: [Z20] Eqs. 13-21.

#include <cstddef>
#include <vector>

#include "random_field/field_spec.hpp"

namespace talus {

/// One eigenpair of exp(-|x-x'|/ell) on [-a, a]: integral of exp(-|x-x'|/ell) f(x') dx' = lambda f(x), f of unit norm.
struct ExponentialMode {
  double w;          ///< wave number                     [rad/m]
  bool cosine;       ///< f = amplitude cos(w x), else amplitude sin(w x)
  double amplitude;  ///< alpha of [Z20] Eqs. 14, 20      [m^-1/2]
  double lambda;     ///< eigenvalue                      [m], > 0

  /// f(x) [m^-1/2]; x is measured from the middle of the interval [m].
  double value(double x) const;
  /// What averaging over [x - width/2, x + width/2] multiplies f(x) with, for every x: sin(q)/q with q = w width/2.
  double averaging_factor(double width) const;
};

/// The n-th eigenpair in order of falling lambda, n = 1, 2, ..., of the covariance exp(-|x-x'|/ell) on [-a, a].
ExponentialMode exponential_mode(int n, double a, double ell);

/// The number n, in the complete set, of the i-th mode (i = 1, 2, ...) of a set of root intervals: i itself for
/// `complete`; 1 4 5 8 9 12 13 ... for `paper`, whose intervals [(i-1) pi/a, (i-1/2) pi/a] for odd i and
/// [(i-1/2) pi/a, i pi/a] for even i ([Z20] Eqs. 15, 21 as printed) leave out every other root of either parity.
int mode_number(int i, RootIntervals intervals);

/// The modes along one axis of the domain, solved when they are first asked for.
class AxisModes {
 public:
  /// Modes of the interval [lo, hi] [m], hi > lo.
  AxisModes(double lo, double hi, double ell, RootIntervals intervals);
  /// The one mode of an axis along which the field does not vary: f = 1, lambda = 1, length 1.
  static AxisModes constant();

  /// Whether there is a mode of that index, counted from 0.
  bool has(std::size_t index) const { return !constant_ || index == 0; }
  /// The mode of that index; counted from 0 in order of falling lambda.
  const ExponentialMode& operator[](std::size_t index);
  const ExponentialMode& solved(std::size_t index) const { return modes_[index]; }
  double centre() const { return centre_; }  ///< middle of the interval [m], [Z20] Eq. 17
  double length() const { return 2 * a_; }   ///< length of the interval [m]; the sum of all lambda of the complete set

 private:
  AxisModes() = default;
  double centre_ = 0.0;
  double a_ = 0.5;
  double ell_ = 1.0;
  RootIntervals intervals_ = RootIntervals::complete;
  bool constant_ = false;
  std::vector<ExponentialMode> modes_;
};

}  // namespace talus

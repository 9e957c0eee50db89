#pragma once
// Eigenpairs of the exponential covariance on an interval, and which of their products a two-dimensional expansion
// keeps: [Z20] Eqs. 13-23.

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

/// The two-dimensional mode f_ix(x) f_iy(y).
struct ModePair {
  std::size_t ix;  ///< index into the modes along x, from 0
  std::size_t iy;  ///< index into the modes along y, from 0
  double lambda;   ///< lambda_ix lambda_iy [m2], [Z20] Eq. 22
};

/// More modes than this are refused: draws and evaluation would take longer than circulant embedding, which truncates
/// nothing.
inline constexpr std::size_t max_modes = 1'000'000;

/// The `count` largest products, largest first; equal ones in order of ix. Takes O(count log count) and solves only the
/// one-dimensional modes it needs. Fewer when there are no more (both axes constant).
std::vector<ModePair> largest_products(AxisModes& x, AxisModes& y, std::size_t count);

/// The products (0,0), (1,1), ...: what [Z20] most likely used. Factors of equal index have equal parity, so that
/// f(-x,-y) = f(x,y): such a field is point-symmetric about the middle of the domain ([Z20] Fig. 3d). Along a single
/// axis (the other one constant) these are the `count` leading modes.
std::vector<ModePair> diagonal_products(AxisModes& x, AxisModes& y, std::size_t count);

/// As few of the largest products as carry `share` of the variance, sum lambda >= share x.length() y.length().
/// @throws ConfigError (/random_field/variance_share) when `limit` modes do not reach the share
std::vector<ModePair> products_reaching(AxisModes& x, AxisModes& y, double share, std::size_t limit = max_modes);

/// sum lambda / (x.length() y.length()) [-], in (0, 1].
double captured_share(const std::vector<ModePair>& pairs, const AxisModes& x, const AxisModes& y);

}  // namespace talus

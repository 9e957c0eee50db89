#include "random_field/exponential_modes.hpp"

#include <boost/math/special_functions/sinc.hpp>
#include <cmath>
#include <numbers>

#include "math/roots.hpp"

namespace talus {

double ExponentialMode::value(double x) const { return amplitude * (cosine ? std::cos(w * x) : std::sin(w * x)); }

double ExponentialMode::averaging_factor(double width) const { return boost::math::sinc_pi(w * width / 2); }

// odd n:  cos(w a)/ell - w sin(w a) = 0   (1/ell - w tan(w a) = 0 without its poles)   [Z20] Eq. 15
// even n: sin(w a)/ell + w cos(w a) = 0   (tan(w a)/ell + w = 0 without its poles)     [Z20] Eq. 21
// Either has one root in [(n-1) pi/(2a), n pi/(2a)]. With w a = (n-1) pi/2 + s both read
//   (a/ell) cos(s) - w a sin(s) = 0,  0 < s < pi/2,
// whose ends have opposite signs whatever a/ell, and sin(2 w a) = (+ odd, - even) sin(2 s) in the norms of Eqs. 14, 20.
ExponentialMode exponential_mode(int n, double a, double ell) {
  const double start = (n - 1) * (std::numbers::pi / 2);
  const auto residual = [&](double s) { return (a / ell) * std::cos(s) - (start + s) * std::sin(s); };
  const double s = bracketed_root(residual, 0.0, std::numbers::pi / 2);
  const double wa = start + s;
  const double w = wa / a;
  return {.w = w,
          .cosine = n % 2 == 1,
          .amplitude = 1 / std::sqrt(a * (1 + std::sin(2 * s) / (2 * wa))),
          .lambda = 2 * ell / (1 + w * w * ell * ell)};
}

int mode_number(int i, RootIntervals intervals) {
  if (intervals == RootIntervals::complete) return i;
  return i % 2 == 1 ? 2 * i - 1 : 2 * i;
}

AxisModes::AxisModes(double lo, double hi, double ell, RootIntervals intervals)
    : centre_((lo + hi) / 2), a_((hi - lo) / 2), ell_(ell), intervals_(intervals) {}

AxisModes AxisModes::constant() {
  AxisModes axis;
  axis.constant_ = true;
  axis.modes_ = {{.w = 0, .cosine = true, .amplitude = 1, .lambda = 1}};
  return axis;
}

const ExponentialMode& AxisModes::operator[](std::size_t index) {
  while (modes_.size() <= index) {
    const int i = static_cast<int>(modes_.size()) + 1;
    modes_.push_back(exponential_mode(mode_number(i, intervals_), a_, ell_));
  }
  return modes_[index];
}

}  // namespace talus

#pragma once
// Roots of functions of one variable.

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <stdexcept>

namespace talus {

/// The root of a continuous f in [lo, hi], to the last bits of a double (Alefeld, Potra & Shi 1995, Algorithm 748).
/// @throws std::domain_error when f(lo) and f(hi) have the same sign, std::runtime_error when 200 evaluations do not do
template <class F>
double bracketed_root(F&& f, double lo, double hi) {
  std::uintmax_t evaluations = 200;
  const boost::math::tools::eps_tolerance<double> tolerance(53);
  const auto [a, b] = boost::math::tools::toms748_solve(f, lo, hi, tolerance, evaluations);
  if (evaluations >= 200) throw std::runtime_error("bracketed_root: no convergence");
  return a + (b - a) / 2;
}

}  // namespace talus

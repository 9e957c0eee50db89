#include "random_field/nataf.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "math/roots.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr int most_terms = 60;  ///< of the series; all but the most U-shaped beta distributions take less than 20
constexpr double reach = 8.5;   ///< of a standard normal number: the rest has a probability of 2e-17
constexpr double step = 1.0 / 32;

/// E[f(Z)]: the trapezoidal rule, which converges faster than any power of the step on a smooth function times the
/// normal density (Trefethen & Weideman 2014, SIAM Rev. 56, 385-458).
template <class F>
void for_each_node(F&& f) {
  const int n = static_cast<int>(reach / step);
  for (int i = -n; i <= n; ++i) {
    const double z = i * step;
    f(z, step * std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi));
  }
}

double standardized(const Marginal& m, double z) { return (m.value(z) - m.mean) / m.stdev; }

using Series = std::array<double, most_terms + 1>;

/// c_k of a marginal. he_0 = 1, he_1 = z, sqrt(k+1) he_{k+1} = z he_k - sqrt(k) he_{k-1}.
Series hermite_series(const Marginal& m) {
  Series c{};
  for_each_node([&](double z, double weight) {
    const double x = weight * standardized(m, z);
    double before = 0.0, he = 1.0;
    for (int k = 0; k <= most_terms; ++k) {
      c[k] += x * he;
      const double next = (z * he - std::sqrt(double(k)) * before) / std::sqrt(k + 1.0);
      before = he;
      he = next;
    }
  });
  return c;
}

/// sum_{k >= 1} c_k d_k rho'^k
double mehler_sum(const Series& c, const Series& d, double gaussian) {
  double sum = 0.0;
  for (int k = most_terms; k >= 1; --k) sum = gaussian * (sum + c[k] * d[k]);
  return sum;
}

}  // namespace

double correlation_after_marginals(const Marginal& a, const Marginal& b, double gaussian) {
  return mehler_sum(hermite_series(a), hermite_series(b), gaussian);
}

Attainable attainable_correlation(const Marginal& a, const Marginal& b) {
  Attainable range{0.0, 0.0};
  for_each_node([&](double z, double weight) {
    range.least += weight * standardized(a, z) * standardized(b, -z);
    range.most += weight * standardized(a, z) * standardized(b, z);
  });
  return range;
}

double gaussian_correlation(const Marginal& a, const Marginal& b, double rho) {
  const Attainable range = attainable_correlation(a, b);
  constexpr double rounding = 1e-9;
  if (rho < range.least - rounding || rho > range.most + rounding)
    throw std::domain_error("cannot be reached with these distributions: they allow " + rounded(range.least) + " to " +
                            rounded(range.most));
  if (rho == 0.0) return 0.0;
  const Series c = hermite_series(a), d = hermite_series(b);
  if (rho >= mehler_sum(c, d, 1.0)) return 1.0;
  if (rho <= mehler_sum(c, d, -1.0)) return -1.0;
  return bracketed_root([&](double gaussian) { return mehler_sum(c, d, gaussian) - rho; }, -1.0, 1.0);
}

}  // namespace talus

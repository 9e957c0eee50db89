#include "random_field/marginal.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "math/roots.hpp"
#include "random_field/random_field.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const boost::math::normal_distribution<double> standard;

double below(double z) { return cdf(standard, z); }
double above(double z) { return cdf(complement(standard, z)); }

/// The quantile Phi(z) of a standard normal number that is known to lie between two bounds.
double between(double lo, double hi, double z) {
  if (lo > 0.0) return -between(-hi, -lo, -z);  // no difference of probabilities near 1
  const double p = below(lo) + below(z) * (below(hi) - below(lo));
  if (p < 0.5) return std::max(lo, p > 0.0 ? quantile(standard, p) : lo);
  const double q = above(hi) + above(z) * (above(lo) - above(hi));
  return std::min(hi, q > 0.0 ? quantile(complement(standard, q)) : hi);
}

struct Moments {
  double mean, stdev;
};

/// Of a normal distribution between bounds, by quadrature over where its density is above 1e-18 of the largest: no
/// closed form stands the cancellation far from the parent's mean.
Moments truncated_moments(double mu, double s, double low, double high) {
  const double gap = std::max({0.0, low - mu, mu - high});
  const double reach = std::sqrt(gap * gap + 83.0 * s * s);
  const double from = std::max(low, mu - reach), to = std::min(high, mu + reach);
  const double middle = (from + to) / 2;
  const auto moment = [&](int n) {
    const auto f = [&](double x) {
      return std::pow(x - middle, n) * std::exp((gap * gap - (x - mu) * (x - mu)) / (2 * s * s));
    };
    return boost::math::quadrature::gauss<double, 60>::integrate(f, from, to);
  };
  const double whole = moment(0), first = moment(1) / whole, second = moment(2) / whole;
  return {middle + first, std::sqrt(std::max(0.0, second - first * first))};
}

/// The parent's mean with which the truncated distribution has this one; it rises with it.
double parent_mean(double mean, double s, double low, double high) {
  const auto excess = [&](double mu) { return truncated_moments(mu, s, low, high).mean - mean; };
  double lo = mean, hi = mean;
  for (double step = s; excess(lo) > 0.0; step *= 2) lo -= step;
  for (double step = s; excess(hi) < 0.0; step *= 2) hi += step;
  return lo == hi ? mean : bracketed_root(excess, lo, hi);
}

[[noreturn]] void refuse(const std::string& why) { throw std::domain_error(why); }

}  // namespace

double Marginal::value(double z) const {
  switch (kind) {
    case MarginalKind::constant:
      return mean;
    case MarginalKind::lognormal:
      return std::exp(a + b * z);
    case MarginalKind::normal:
      if (low == -infinity && high == infinity) return a + b * z;
      return std::clamp(a + b * between((low - a) / b, (high - a) / b, z), low, high);
    case MarginalKind::uniform:
      return z < 0.0 ? low + (high - low) * below(z) : high - (high - low) * above(z);
    case MarginalKind::beta: {
      const boost::math::beta_distribution<double> of(a, b);
      const double share = z < 0.0 ? quantile(of, below(z)) : quantile(complement(of, above(z)));
      return low + (high - low) * share;
    }
  }
  return mean;
}

double Marginal::normal_number(double x) const {
  if (x == value(-farthest)) return -farthest;
  return bracketed_root([&](double z) { return value(z) - x; }, -farthest, farthest);
}

double Marginal::slope(double z) const {
  constexpr double step = 1e-4;  // its error is of the second order, 1e-8
  return (value(z + step) - value(z - step)) / (2 * step);
}

Marginal Marginal::averaged(double share) const {
  if (share == 1.0) return *this;
  const double less = stdev * std::sqrt(share);
  switch (kind) {
    case MarginalKind::constant:
      return *this;
    case MarginalKind::lognormal:
      return lognormal_marginal(mean, b * std::sqrt(share));
    case MarginalKind::normal:
      return normal_marginal(mean, less, low, high);
    case MarginalKind::uniform:
      return uniform_marginal(mean - std::numbers::sqrt3 * less, mean + std::numbers::sqrt3 * less);
    case MarginalKind::beta:
      return beta_marginal(mean, less, low, high);
  }
  return *this;
}

Marginal constant_marginal(double value) {
  return {.kind = MarginalKind::constant, .mean = value, .low = value, .high = value};
}

Marginal lognormal_marginal(double mean, double log_stdev) {
  if (!(mean > 0.0)) refuse("a lognormal distribution needs a mean above 0");
  return {.kind = MarginalKind::lognormal,
          .mean = mean,
          .stdev = mean * coefficient_of_variation(log_stdev, 1.0),
          .a = std::log(mean) - log_stdev * log_stdev / 2,
          .b = log_stdev,
          .low = 0.0,
          .high = infinity};
}

Marginal normal_marginal(double mean, double stdev, double low, double high) {
  if (!(low < mean && mean < high)) refuse("the mean does not lie between low and high");
  Marginal m{MarginalKind::normal, mean, stdev, mean, stdev, low, high};
  if (stdev == 0.0) return constant_marginal(mean);
  const auto moments = [&](double s) { return truncated_moments(parent_mean(mean, s, low, high), s, low, high); };
  constexpr double far = 9.0;  // standard deviations, beyond which no draw comes
  if (low <= mean - far * stdev && high >= mean + far * stdev) return m;
  const double widest = 30.0 * std::min(high - low, 3.0 * std::min(mean - low, high - mean));
  const double most = moments(widest).stdev;
  if (stdev > most)
    refuse("a normal distribution truncated there has a coefficient of variation of at most " +
           rounded(most / std::abs(mean)) + "; give less, other bounds, or another distribution");
  m.b = bracketed_root([&](double s) { return moments(s).stdev - stdev; }, 0.5 * stdev, widest);
  m.a = parent_mean(mean, m.b, low, high);
  return m;
}

Marginal beta_marginal(double mean, double stdev, double low, double high) {
  if (!(low < mean && mean < high)) refuse("the mean does not lie between low and high");
  if (stdev == 0.0) return constant_marginal(mean);
  const double share = (mean - low) / (high - low), spread = stdev / (high - low);
  const double sum = share * (1.0 - share) / (spread * spread) - 1.0;  // of the exponents
  constexpr double least_sum = 0.1;  // below it, nearly all of the distribution lies at the bounds
  if (!(sum > least_sum))
    refuse("a beta distribution between these bounds has a coefficient of variation below " +
           rounded(std::sqrt((mean - low) * (high - mean) / (1.0 + least_sum)) / std::abs(mean)));
  return {MarginalKind::beta, mean, stdev, share * sum, (1.0 - share) * sum, low, high};
}

Marginal uniform_marginal(double low, double high) {
  if (!(low < high)) refuse("low is not below high");
  return {.kind = MarginalKind::uniform,
          .mean = (low + high) / 2,
          .stdev = (high - low) / std::sqrt(12.0),
          .low = low,
          .high = high};
}

Marginal make_marginal(const PropertySpec& spec, double of_material) {
  const double mean = spec.mean.value_or(of_material);
  const double stdev = spec.stdev.value_or(spec.cov.value_or(0.0) * mean);
  switch (spec.marginal) {
    case MarginalKind::constant:
      return constant_marginal(mean);
    case MarginalKind::lognormal: {
      if (!spec.mean && !spec.log_mean && !(of_material > 0.0))
        refuse("a lognormal distribution needs a mean above 0, and the material has none; give the mean");
      if (!spec.log_stdev) return lognormal_marginal(mean, log_stdev(stdev / mean));
      const double sigma = *spec.log_stdev, median = spec.log_mean ? std::exp(*spec.log_mean) : of_material;
      return lognormal_marginal(median * std::exp(sigma * sigma / 2), sigma);
    }
    case MarginalKind::normal: {
      const bool heavy = spec.property == Property::unit_weight;  // soil without weight cannot be simulated
      return normal_marginal(mean, stdev, spec.low.value_or(heavy ? mean / 2 : 0.0), spec.high.value_or(infinity));
    }
    case MarginalKind::beta:
      return beta_marginal(mean, stdev, spec.low.value_or(0.0), spec.high.value_or(0.0));
    case MarginalKind::uniform: {
      const double half = std::numbers::sqrt3 * stdev;
      const double low = spec.low.value_or(mean - half), high = spec.high.value_or(mean + half);
      if (low < 0.0)
        refuse("a uniform distribution with this mean reaches below 0: its coefficient of variation is at most " +
               rounded(1.0 / std::numbers::sqrt3));
      return uniform_marginal(low, high);
    }
  }
  return constant_marginal(mean);
}

}  // namespace talus

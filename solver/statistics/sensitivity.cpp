#include "statistics/sensitivity.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

using Column = Regression::Column;

/// The jackknife estimate and interval from the values that a statistic has without each of the sample.
VarianceShare jackknife(double whole, const Column& without, double freedom) {
  const auto n = static_cast<double>(without.size());
  Column pseudo(without.size());
  std::ranges::transform(without, pseudo.begin(), [&](double value) { return n * whole - (n - 1) * value; });
  const SampleMoments m = moments(pseudo);
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), 0.025));
  const double half_width = t * m.stdev.value_or(0.0) / std::sqrt(n);
  const auto cut = [](double share) { return std::clamp(share, 0.0, 1.0); };
  return {cut(*m.mean), {cut(*m.mean - half_width), cut(*m.mean + half_width)}};
}

}  // namespace

std::vector<VarianceShare> variance_shares(const Regression& of, std::span<const double> y,
                                           std::span<const std::size_t> group_of, std::size_t groups) {
  const std::size_t n = y.size();
  const Column u = of.left_out_residuals(), e = of.residuals();
  const double freedom = of.degrees_of_freedom(), squares = of.squared_residuals();
  double variance = squares / freedom;  // of the residuals; then of y
  Column variance_without(n);
  for (std::size_t i = 0; i < n; ++i) variance_without[i] = (squares - e[i] * u[i]) / (freedom - 1);
  std::vector<double> whole(groups, 0.0);
  std::vector<Column> without(groups, Column(n, 0.0));
  for (std::size_t k = 1; k <= of.size(); ++k) {
    const Column w = of.weights(k);
    const double b = std::inner_product(w.begin(), w.end(), y.begin(), 0.0);
    const std::size_t group = group_of[of.variable(k)];
    whole[group] += b * b;
    variance += b * b;
    for (std::size_t i = 0; i < n; ++i) {
      const double square = (b - w[i] * u[i]) * (b - w[i] * u[i]);
      without[group][i] += square;
      variance_without[i] += square;
    }
  }
  std::vector<VarianceShare> shares(groups, {0.0, {0.0, 0.0}});
  for (std::size_t g = 0; g < groups; ++g) {
    if (!(whole[g] > 0.0)) continue;
    for (std::size_t i = 0; i < n; ++i) without[g][i] /= variance_without[i];
    shares[g] = jackknife(whole[g] / variance, without[g], freedom);
  }
  return shares;
}

}  // namespace talus

#include "statistics/controlled_mean.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

using Column = Regression::Column;

constexpr double each_side = 0.025;  // probability beyond each end of a 95 % interval

double student(double freedom) {
  return boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), each_side));
}

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Interval around(double value, double half_width) { return {value - half_width, value + half_width}; }

/// HC3: sum_i a_i b_i u_i^2 with the weights a, b of two coefficients and the left-out residuals u.
double covariance(const Column& a, const Column& b, const Column& u) {
  double sum = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += a[i] * b[i] * u[i] * u[i];
  return sum;
}

}  // namespace

std::optional<ControlledMean> controlled_mean(std::span<const double> y, std::span<const Column> controls) {
  const Regression of = best_regression(y, controls);
  if (y.size() < 2) return {};
  return controlled_mean(of, y);
}

ControlledMean controlled_mean(const Regression& of, std::span<const double> y) {
  const Column u = of.left_out_residuals(), intercept = of.weights(0);
  const double t = student(of.degrees_of_freedom()), squared_error = covariance(intercept, intercept, u);
  ControlledMean result;
  result.mean = dot(intercept, y);
  result.standard_error = std::sqrt(squared_error);
  result.ci95 = around(result.mean, t * result.standard_error);
  std::vector<Column> weights;
  for (std::size_t k = 1; k <= of.size(); ++k) weights.push_back(of.weights(k));
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double value = dot(weights[k], y);
    result.slopes.push_back({.variable = of.variable(k + 1),
                             .value = value,
                             .ci95 = around(value, t * std::sqrt(covariance(weights[k], weights[k], u)))});
    Column& row = result.slope_covariance.emplace_back();
    for (const Column& other : weights) row.push_back(covariance(weights[k], other, u));
  }
  result.student = t;
  const double s = moments(y).stdev.value_or(0.0), variance = s * s;
  result.residual_share = variance > 0.0 ? of.squared_residuals() / of.degrees_of_freedom() / variance : 0.0;
  result.worth = squared_error > 0.0 ? variance / squared_error : static_cast<double>(y.size());
  return result;
}

}  // namespace talus

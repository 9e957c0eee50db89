#include "statistics/controlled_mean.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace talus {
namespace {

using Column = std::vector<double>;

constexpr double tail = 0.025;                // each side of a two-sided 95 % interval
constexpr double least_new_direction = 1e-8;  // of a control's length, beyond the controls before it

double dot(const Column& a, const Column& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }
double length(const Column& a) { return std::sqrt(dot(a, a)); }
/// a += factor b
void add(Column& a, double factor, const Column& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

/// The regressions on ever more controls, by Gram and Schmidt: `used` gives control = sum_j r_jk q_j with orthonormal
/// q_j, of which q_0 is constant.
class Regression {
 public:
  explicit Regression(std::span<const double> y) : residual_(y.begin(), y.end()), leverage_(y.size(), 0.0) {
    take(Column(y.size(), 1.0), 0);
  }

  /// @return false where the control brings nothing new
  bool add_control(const Column& control, std::size_t variable) { return take(control, variable); }

  std::size_t controls() const { return q_.size() - 1; }
  /// Residuals that each value has in the regression on all the others.
  Column left_out_residuals() const {
    Column u(residual_.size());
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = residual_[i] / (1.0 - std::min(leverage_[i], 1.0 - 1e-12));
    return u;
  }
  double squared_residuals() const { return dot(residual_, residual_); }

  /// The weights with which y gives coefficient k of the regression (0: the intercept), as R^-1 Q'.
  Column weights(std::size_t k) const {
    const std::size_t m = q_.size();
    Column row(m, 0.0);  // of R^-1
    for (std::size_t j = k; j < m; ++j) {
      double sum = j == k ? 1.0 : 0.0;
      for (std::size_t i = k; i < j; ++i) sum -= row[i] * r_[j][i];
      row[j] = sum / r_[j][j];
    }
    Column weights(residual_.size(), 0.0);
    for (std::size_t j = k; j < m; ++j) add(weights, row[j], q_[j]);
    return weights;
  }
  std::size_t variable(std::size_t k) const { return variables_[k]; }

 private:
  bool take(Column column, std::size_t variable) {
    const double before = length(column);
    Column r(q_.size() + 1, 0.0);
    for (int pass = 0; pass < 2; ++pass)  // the second takes off what rounding left of the first
      for (std::size_t j = 0; j < q_.size(); ++j) {
        const double along = dot(q_[j], column);
        r[j] += along;
        add(column, -along, q_[j]);
      }
    const double rest = length(column);
    if (!(rest > least_new_direction * before)) return false;
    r.back() = rest;
    for (double& value : column) value /= rest;
    add(residual_, -dot(column, residual_), column);
    for (std::size_t i = 0; i < column.size(); ++i) leverage_[i] += column[i] * column[i];
    r_.push_back(std::move(r));
    q_.push_back(std::move(column));
    variables_.push_back(variable);
    return true;
  }

  Column residual_, leverage_;
  std::vector<Column> q_, r_;  ///< r_[k][j], j <= k
  std::vector<std::size_t> variables_;
};

/// What a regression says of y.
ControlledMean conclusions(const Regression& of, std::span<const double> y) {
  const Column left_out = of.left_out_residuals();
  const auto n = static_cast<double>(y.size()), freedom = n - static_cast<double>(of.controls()) - 1.0;
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), tail));
  const auto coefficient = [&](std::size_t k, double& value, double& error) {
    const Column w = of.weights(k);
    value = std::inner_product(w.begin(), w.end(), y.begin(), 0.0);
    error = 0.0;
    for (std::size_t i = 0; i < w.size(); ++i) error += w[i] * w[i] * left_out[i] * left_out[i];
    error = std::sqrt(error);
    return Interval{value - t * error, value + t * error};
  };
  ControlledMean result;
  result.ci95 = coefficient(0, result.mean, result.standard_error);
  for (std::size_t k = 1; k <= of.controls(); ++k) {
    Slope slope{.variable = of.variable(k)};
    double error = 0.0;
    slope.ci95 = coefficient(k, slope.value, error);
    result.slopes.push_back(slope);
  }
  const double s = moments(y).stdev.value_or(0.0), variance = s * s;
  result.residual_share = variance > 0.0 ? of.squared_residuals() / freedom / variance : 0.0;
  const double squared_error = result.standard_error * result.standard_error;
  result.worth = squared_error > 0.0 ? variance / squared_error : n;
  return result;
}

}  // namespace

std::optional<ControlledMean> controlled_mean(std::span<const double> y, std::span<const Column> controls) {
  for (const Column& control : controls)
    if (control.size() != y.size()) throw std::invalid_argument("controlled_mean: a control for each value of y");
  if (y.size() < 2) return {};
  const std::size_t most = y.size() / runs_per_control;
  Regression now(y), best = now;
  const auto error_of = [](const Regression& of) {
    const Column u = of.left_out_residuals();
    return dot(u, u);
  };
  double least = error_of(now);
  for (std::size_t k = 0; k < controls.size() && now.controls() < most; ++k) {
    if (!now.add_control(controls[k], k)) continue;
    if (const double error = error_of(now); error < least) {
      least = error;
      best = now;
    }
  }
  return conclusions(best, y);
}

}  // namespace talus

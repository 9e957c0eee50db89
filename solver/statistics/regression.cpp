#include "statistics/regression.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace talus {
namespace {

using Column = Regression::Column;

constexpr double least_new_direction = 1e-8;  // of a variable's length, beyond the variables before it

double dot(const Column& a, const Column& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }
double length(const Column& a) { return std::sqrt(dot(a, a)); }
/// a += factor b
void add_to(Column& a, double factor, const Column& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

double press(const Regression& of) {
  const Column u = of.left_out_residuals();
  return dot(u, u);
}

}  // namespace

Regression::Regression(std::span<const double> y) : residual_(y.begin(), y.end()), leverage_(y.size(), 0.0) {
  take(Column(y.size(), 1.0), 0);
}

bool Regression::take(Column column, std::size_t variable) {
  const double before = length(column);
  Column r(q_.size() + 1, 0.0);
  for (int pass = 0; pass < 2; ++pass)  // the second takes off what rounding left of the first
    for (std::size_t j = 0; j < q_.size(); ++j) {
      const double along = dot(q_[j], column);
      r[j] += along;
      add_to(column, -along, q_[j]);
    }
  const double rest = length(column);
  if (!(rest > least_new_direction * before)) return false;
  r.back() = rest;
  for (double& value : column) value /= rest;
  add_to(residual_, -dot(column, residual_), column);
  for (std::size_t i = 0; i < column.size(); ++i) leverage_[i] += column[i] * column[i];
  r_.push_back(std::move(r));
  q_.push_back(std::move(column));
  variables_.push_back(variable);
  return true;
}

double Regression::degrees_of_freedom() const {
  return static_cast<double>(residual_.size()) - static_cast<double>(size()) - 1.0;
}

double Regression::squared_residuals() const { return dot(residual_, residual_); }

Column Regression::left_out_residuals() const {
  Column u(residual_.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = residual_[i] / (1.0 - std::min(leverage_[i], 1.0 - 1e-12));
  return u;
}

Column Regression::weights(std::size_t k) const {
  const std::size_t m = q_.size();
  Column row(m, 0.0);  // of R^-1
  for (std::size_t j = k; j < m; ++j) {
    double sum = j == k ? 1.0 : 0.0;
    for (std::size_t i = k; i < j; ++i) sum -= row[i] * r_[j][i];
    row[j] = sum / r_[j][j];
  }
  Column weights(residual_.size(), 0.0);
  for (std::size_t j = k; j < m; ++j) add_to(weights, row[j], q_[j]);
  return weights;
}

Regression best_regression(std::span<const double> y, std::span<const Column> controls) {
  for (const Column& control : controls)
    if (control.size() != y.size()) throw std::invalid_argument("best_regression: a control for each value of y");
  const std::size_t most = y.size() / runs_per_control;
  Regression now(y), best = now;
  double least = press(now);
  for (std::size_t k = 0; k < controls.size() && now.size() < most; ++k) {
    if (!now.add(controls[k], k)) continue;
    if (const double error = press(now); error < least) {
      least = error;
      best = now;
    }
  }
  return best;
}

}  // namespace talus

#include "random_field/conditioning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "support/error.hpp"

namespace talus {
namespace {

/// Variance that a datum keeps when all before it are known, below which it adds nothing but rounding [-].
constexpr double least_remainder = 1e-9;

void merge(GaussianDatum& into, const GaussianDatum& datum) {
  if (into.error == 0) return;
  if (datum.error == 0) {
    into = datum;
    return;
  }
  const double a = 1 / (into.error * into.error), b = 1 / (datum.error * datum.error);
  into = {into.x, (a * into.z + b * datum.z) / (a + b), 1 / std::sqrt(a + b)};
}

[[noreturn]] void refuse(const std::vector<Vec2>& points, std::size_t k) {
  std::size_t nearest = k == 0 ? 1 : 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i != k && norm2(points[i] - points[k]) < norm2(points[nearest] - points[k])) nearest = i;
  std::ostringstream text;
  text << "has data so near to one another that no field of this covariance meets all of them: two are "
       << norm(points[nearest] - points[k]) << " m apart; give them standard errors, or leave one out";
  throw ConfigError("/random_field/data", text.str());
}

}  // namespace

std::vector<GaussianDatum> merged(std::span<const GaussianDatum> data) {
  std::vector<GaussianDatum> out;
  for (const GaussianDatum& datum : data) {
    const auto known =
        std::ranges::find_if(out, [&](const GaussianDatum& d) { return norm(d.x - datum.x) < same_point; });
    if (known == out.end())
      out.push_back(datum);
    else
      merge(*known, datum);
  }
  return out;
}

Conditioning::Conditioning(const Correlation& correlation, double nugget, std::vector<GaussianDatum> data)
    : correlation_(correlation), continuous_(1 - nugget) {
  const auto n = static_cast<Eigen::Index>(data.size());
  z_.resize(n);
  noise_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const GaussianDatum& datum = data[static_cast<std::size_t>(i)];
    points_.push_back(datum.x);
    z_[i] = datum.z;
    noise_[i] = std::sqrt(datum.error * datum.error + nugget);
  }
  Eigen::MatrixXd k = data_covariance();
  k.diagonal() += noise_.cwiseAbs2();
  factor_.compute(k);
  const Eigen::VectorXd remainder = Eigen::MatrixXd(factor_.matrixL()).diagonal();
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(remainder[i] * remainder[i] > least_remainder)) refuse(points_, static_cast<std::size_t>(i));
}

Eigen::MatrixXd Conditioning::data_covariance() const {
  const auto n = static_cast<Eigen::Index>(size());
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index j = 0; j < n; ++j) k.col(j) = covariances(points_[static_cast<std::size_t>(j)], 0.0);
  return k;
}

Eigen::VectorXd Conditioning::covariances(Vec2 x, double cell) const {
  Eigen::VectorXd c(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i)
    c[static_cast<Eigen::Index>(i)] = continuous_ * correlation_.with_cell(x - points_[i], cell);
  return c;
}

Eigen::VectorXd Conditioning::coefficients(std::span<const double> y, std::span<const double> eta) const {
  Eigen::VectorXd residual = z_;
  for (std::size_t i = 0; i < size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    residual[k] += noise_[k] * eta[i] - y[i];
  }
  return factor_.solve(residual);
}

double Conditioning::correction(Vec2 x, double cell, const Eigen::VectorXd& a) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i)
    sum += continuous_ * correlation_.with_cell(x - points_[i], cell) * a[static_cast<Eigen::Index>(i)];
  return sum;
}

double Conditioning::variance(Vec2 x, double cell, double v, const Eigen::VectorXd& c,
                              const Eigen::MatrixXd& v_data) const {
  const Eigen::VectorXd w = factor_.solve(covariances(x, cell));
  return v - 2 * w.dot(c) + w.dot(v_data * w) + w.cwiseAbs2().dot(noise_.cwiseAbs2());
}

}  // namespace talus

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
  into.z = (a * into.z + b * datum.z) / (a + b);
  into.error = 1 / std::sqrt(a + b);
}

/// N with N N^T = S. Without a nugget S is diagonal, and may have zeros there.
Eigen::MatrixXd noise_factor(const std::vector<GaussianDatum>& data, const Eigen::MatrixXd& common, double nugget) {
  const auto n = static_cast<Eigen::Index>(data.size());
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const GaussianDatum& datum = data[static_cast<std::size_t>(i)];
    s(i, i) = nugget > 0 ? datum.error * datum.error + nugget : datum.error;
    for (Eigen::Index j = 0; j < i; ++j)
      if (nugget > 0 && norm(data[static_cast<std::size_t>(j)].x - datum.x) < same_point)
        s(i, j) = s(j, i) = nugget * common(i, j);
  }
  return nugget > 0 ? Eigen::MatrixXd(s.llt().matrixL()) : s;
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
    const auto known = std::ranges::find_if(
        out, [&](const GaussianDatum& d) { return d.weights == datum.weights && norm(d.x - datum.x) < same_point; });
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
  const auto fields = data.empty() ? 0 : static_cast<Eigen::Index>(data.front().weights.size());
  z_.resize(n);
  weights_.resize(n, fields);
  for (Eigen::Index i = 0; i < n; ++i) {
    const GaussianDatum& datum = data[static_cast<std::size_t>(i)];
    points_.push_back(datum.x);
    z_[i] = datum.z;
    weights_.row(i) = Eigen::Map<const Eigen::RowVectorXd>(datum.weights.data(), fields);
  }
  noise_ = noise_factor(data, common(), nugget);
  Eigen::MatrixXd k = common();
  for (Eigen::Index j = 0; j < n; ++j) k.col(j).array() *= covariances(points_[static_cast<std::size_t>(j)], 0).array();
  k += noise_ * noise_.transpose();
  factor_.compute(k);
  const Eigen::VectorXd remainder = Eigen::MatrixXd(factor_.matrixL()).diagonal();
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(remainder[i] * remainder[i] > least_remainder)) refuse(points_, static_cast<std::size_t>(i));
}

Eigen::VectorXd Conditioning::common(std::span<const double> weights) const {
  return weights_ * Eigen::Map<const Eigen::VectorXd>(weights.data(), weights_.cols());
}

Eigen::VectorXd Conditioning::of_field(const Eigen::VectorXd& a, std::size_t field) const {
  return weights_.col(static_cast<Eigen::Index>(field)).cwiseProduct(a);
}

Eigen::VectorXd Conditioning::covariances(Vec2 x, double cell) const {
  Eigen::VectorXd c(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i)
    c[static_cast<Eigen::Index>(i)] = continuous_ * correlation_.with_cell(x - points_[i], cell);
  return c;
}

Eigen::VectorXd Conditioning::coefficients(std::span<const double> y, std::span<const double> eta) const {
  const auto n = static_cast<Eigen::Index>(size());
  const Eigen::Map<const Eigen::VectorXd> drawn(y.data(), n), normal(eta.data(), n);
  return factor_.solve(z_ + noise_ * normal - drawn);
}

double Conditioning::correction(Vec2 x, double cell, const Eigen::VectorXd& a) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i)
    sum += continuous_ * correlation_.with_cell(x - points_[i], cell) * a[static_cast<Eigen::Index>(i)];
  return sum;
}

double Conditioning::variance(const Eigen::VectorXd& k, double v, const Eigen::VectorXd& c,
                              const Eigen::MatrixXd& v_data) const {
  const Eigen::VectorXd l = factor_.solve(k);
  return v - 2 * l.dot(c) + l.dot(v_data * l) + (noise_.transpose() * l).squaredNorm();
}

}  // namespace talus

#include "random_field/covariance.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <stdexcept>

#include "random_field/field_spec.hpp"

namespace talus {
namespace {

double matern_3_2(double r) {
  const double s = std::numbers::sqrt3 * r;
  return (1 + s) * std::exp(-s);
}

double matern_5_2(double r) {
  const double s = std::sqrt(5.0) * r;
  return (1 + s + s * s / 3) * std::exp(-s);
}

/// integral_0^1 f(s) ds for an f that may be steep at 0: s = u^3.
template <class F>
double integral_from_steep_end(F f) {
  return boost::math::quadrature::gauss<double, 30>::integrate([&](double u) { return 3 * u * u * f(u * u * u); }, 0.0,
                                                               1.0);
}

}  // namespace

double scale_of_fluctuation_factor(Covariance family) {
  switch (family) {
    case Covariance::exponential:
    case Covariance::exponential_isotropic:
      return 2;
    case Covariance::squared_exponential:
      return std::sqrt(std::numbers::pi);
    case Covariance::matern_3_2:
      return 4 / std::numbers::sqrt3;
    case Covariance::matern_5_2:
      return 16 / (3 * std::sqrt(5.0));
    case Covariance::cosine_exponential:
      return 1;
  }
  throw std::logic_error("scale_of_fluctuation_factor: no such family");
}

Correlation::Correlation(const FieldSpec& spec)
    : family_(spec.covariance),
      inverse_{spec.along_x() ? 1 / spec.ell_x : 0.0, spec.along_y() ? 1 / spec.ell_y : 0.0} {}

double Correlation::operator()(Vec2 lag) const {
  const double x = std::abs(lag.x) * inverse_.x, y = std::abs(lag.y) * inverse_.y;
  const double square = x * x + y * y;
  switch (family_) {
    case Covariance::exponential:
      return std::exp(-x - y);
    case Covariance::exponential_isotropic:
      return std::exp(-std::sqrt(square));
    case Covariance::squared_exponential:
      return std::exp(-square);
    case Covariance::matern_3_2:
      return matern_3_2(std::sqrt(square));
    case Covariance::matern_5_2:
      return matern_5_2(std::sqrt(square));
    case Covariance::cosine_exponential:
      return std::exp(-x - y) * std::cos(x) * std::cos(y);
  }
  throw std::logic_error("Correlation: no such family");
}

double Correlation::with_cell(Vec2 lag, double cell) const {
  if (cell == 0) return (*this)(lag);
  const auto parts = [&](double inverse) {
    return inverse == 0 ? 1 : static_cast<int>(std::clamp(std::ceil(4 * cell * inverse), 2.0, 16.0));
  };
  const int nx = parts(inverse_.x), ny = parts(inverse_.y);
  double sum = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) sum += (*this)(lag + cell * Vec2{(i + 0.5) / nx - 0.5, (j + 0.5) / ny - 0.5});
  return sum / (nx * ny);
}

double Correlation::cell_variance(double cell) const {
  if (cell == 0) return 1;
  return 4 * integral_from_steep_end([&](double t) {
           return (1 - t) * integral_from_steep_end([&](double s) { return (1 - s) * (*this)({s * cell, t * cell}); });
         });
}

}  // namespace talus

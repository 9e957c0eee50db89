#include "random_field/circulant_embedding.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace talus {
namespace {

using Spectrum = std::vector<std::complex<double>>;

/// Eigenvalues of the circulant matrix whose first row is C at lags 0, 1, .., period/2, .., 1 times the spacing.
std::vector<double> eigenvalues(const ExponentialCovariance& covariance, double spacing, std::size_t period) {
  std::vector<double> row(period);
  for (std::size_t k = 0; k < period; ++k) row[k] = covariance(static_cast<double>(std::min(k, period - k)) * spacing);
  Spectrum spectrum(period);
  Eigen::FFT<double>().fwd(spectrum.data(), row.data(), static_cast<Eigen::Index>(period));
  std::vector<double> eigen(period);
  std::transform(spectrum.begin(), spectrum.end(), eigen.begin(), [](auto z) { return z.real(); });
  return eigen;
}

CirculantAxis axis(const FieldSpec& spec, Box domain, double dx, bool horizontal) {
  if (!(horizontal ? spec.along_x() : spec.along_y())) return CirculantAxis::constant();
  check_grid_size(spec, domain);
  const ExponentialCovariance covariance{horizontal ? spec.ell_x : spec.ell_y, spec.cell_average ? dx : 0.0};
  const double spacing = grid_spacing(spec, covariance.ell);
  return horizontal ? CirculantAxis(domain.lo.x, domain.hi.x, spacing, covariance)
                    : CirculantAxis(domain.lo.y, domain.hi.y, spacing, covariance);
}

}  // namespace

// With G'' = exp(-|s|/ell), G = ell |s| + ell^2 exp(-|s|/ell), the average is (G(d+h) - 2 G(d) + G(d-h)) / h^2. The
// straight parts of G cancel for d >= h; what is left of the exponentials is a sinh.
double ExponentialCovariance::operator()(double d) const {
  d = std::abs(d);
  const double h = cell;
  if (h == 0) return std::exp(-d / ell);
  if (d >= h) {
    const double s = std::sinh(h / (2 * ell)) * 2 * ell / h;
    return s * s * std::exp(-d / ell);
  }
  const double straight = 2 * (h - d) / ell;
  const double curved = std::exp(-(d + h) / ell) - 2 * std::exp(-d / ell) + std::exp(-(h - d) / ell);
  return (ell / h) * (ell / h) * (straight + curved);
}

// The exponential covariance is convex, so the smallest embedding is nonnegative definite (Dietrich & Newsam 1997).
CirculantAxis::CirculantAxis(double lo, double hi, double spacing, const ExponentialCovariance& covariance)
    : axis_(lo, hi, spacing), cell_(covariance.cell), variance_(covariance(0)) {
  const ExponentialCovariance of_nodes{covariance.ell};
  correlation_ = of_nodes(spacing);
  root_ = eigenvalues(of_nodes, spacing, fast_length(2 * (nodes() - 1)));
  for (double& value : root_) value = std::sqrt(std::max(value, 0.0));
}

void CirculantAxis::filter(std::span<double> row) const {
  const auto n = static_cast<Eigen::Index>(period());
  if (n == 1) return;
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Spectrum spectrum(period() / 2 + 1);
  fft.fwd(spectrum.data(), row.data(), n);
  for (std::size_t k = 0; k < spectrum.size(); ++k) spectrum[k] *= root_[k];
  fft.inv(row.data(), spectrum.data(), n);
}

/// sum_ij w_i w_j r^|i-j|, with r the correlation of neighbours.
double CirculantAxis::variance_of(const Stencil& stencil) const {
  double sum = 0, left = 0;  // left: sum over j < i of w_j r^(i-j)
  for (double w : stencil.weights) {
    sum += w * (w + 2 * left);
    left = correlation_ * (left + w);
  }
  return sum;
}

Stencil CirculantAxis::stencil(double x) const {
  Stencil stencil = axis_.stencil(x, cell_);
  if (nodes() == 1 || cell_ == 0) return stencil;
  const double scale = std::sqrt(variance_ / variance_of(stencil));
  for (double& w : stencil.weights) w *= scale;
  return stencil;
}

CirculantEmbedding::CirculantEmbedding(const FieldSpec& spec, Box domain, double dx)
    : x_(axis(spec, domain, dx, true)), y_(axis(spec, domain, dx, false)) {}

/// Values on the nodes, x fastest: white noise filtered along x, then along y.
std::vector<double> CirculantEmbedding::grid(std::span<const double> xi) const {
  std::vector<double> noise(xi.begin(), xi.end());
  for (std::size_t j = 0; j < y_.period(); ++j) x_.filter(std::span(noise).subspan(j * x_.period(), x_.period()));
  std::vector<double> z(x_.nodes() * y_.nodes());
  std::vector<double> column(y_.period());
  for (std::size_t i = 0; i < x_.nodes(); ++i) {
    for (std::size_t j = 0; j < y_.period(); ++j) column[j] = noise[j * x_.period() + i];
    y_.filter(column);
    for (std::size_t j = 0; j < y_.nodes(); ++j) z[j * x_.nodes() + i] = column[j];
  }
  return z;
}

std::vector<double> CirculantEmbedding::gaussian(std::span<const Vec2> points, std::span<const double> xi) const {
  const std::vector<double> z = grid(xi);
  std::vector<double> values;
  values.reserve(points.size());
  for (Vec2 point : points) {
    const auto along_x = x_.stencil(point.x), along_y = y_.stencil(point.y);
    double sum = 0;
    for (std::size_t j = 0; j < along_y.weights.size(); ++j) {
      const double* row = z.data() + (along_y.first + j) * x_.nodes() + along_x.first;
      sum += along_y.weights[j] * std::inner_product(along_x.weights.begin(), along_x.weights.end(), row, 0.0);
    }
    values.push_back(sum);
  }
  return values;
}

}  // namespace talus

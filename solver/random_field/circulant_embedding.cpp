#include "random_field/circulant_embedding.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <sstream>
#include <unsupported/Eigen/FFT>

#include "support/error.hpp"

namespace talus {
namespace {

constexpr double clip_tolerance = 1e-8;  // largest error of the covariance, relative to C(0), that clipping may make
constexpr double rounding = 1e-9;        // parts of a spacing that count as rounding

using Spectrum = std::vector<std::complex<double>>;

/// The smallest 4 * 2^a 3^b 5^c that is at least n: a length that the FFT is fast at.
std::size_t fast_length(std::size_t n) {
  for (std::size_t m = (n + 3) / 4;; ++m) {
    std::size_t rest = std::max<std::size_t>(m, 1);
    for (std::size_t prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return 4 * std::max<std::size_t>(m, 1);
  }
}

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

/// By how much setting negative eigenvalues to zero can change the covariance, relative to C(0) (its mean eigenvalue).
double clipping_error(const std::vector<double>& eigen) {
  double negative = 0, all = 0;
  for (double value : eigen) {
    negative += std::max(-value, 0.0);
    all += value;
  }
  return negative / all;
}

double default_spacing(const FieldSpec& spec, double dx) {
  const double ell = !spec.along_y() ? spec.ell_x : !spec.along_x() ? spec.ell_y : std::min(spec.ell_x, spec.ell_y);
  return dx / (2 * std::max(1.0, std::ceil(2 * dx / ell)));
}

void check_size(double nodes) {
  if (nodes <= max_grid) return;
  std::ostringstream text;
  text << "the grid takes at least " << nodes << " coefficients, more than " << max_grid << "; give a larger spacing";
  throw ConfigError("/random_field/grid_spacing_m", text.str());
}

CirculantAxis axis(double lo, double hi, double ell, bool varies, const FieldSpec& spec, double dx, double anchor) {
  if (!varies) return CirculantAxis::constant();
  const double spacing = spec.grid_spacing.value_or(default_spacing(spec, dx));
  const double first = anchor + std::floor((lo - anchor) / spacing + rounding) * spacing;
  return {first, hi, spacing, {ell, spec.cell_average ? dx : 0.0}};
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

// The exponential covariance is convex, so the smallest embedding is nonnegative definite (Dietrich & Newsam 1997). The
// averaged one is not; there the period grows until the kink at half of it has faded.
CirculantAxis::CirculantAxis(double lo, double hi, double spacing, const ExponentialCovariance& covariance)
    : lo_(lo), spacing_(spacing) {
  const double intervals = std::max(1.0, std::ceil((hi - lo) / spacing - rounding));
  check_size(2 * intervals);
  nodes_ = static_cast<std::size_t>(intervals) + 1;
  variance_ = covariance(0);
  std::size_t period = fast_length(2 * (nodes_ - 1));
  root_ = eigenvalues(covariance, spacing_, period);
  while (clipping_error(root_) > clip_tolerance) {
    if (2 * static_cast<double>(period) > max_grid)
      throw ConfigError("/random_field/grid_spacing_m", "no embedding of the covariance is nonnegative definite");
    period = fast_length(2 * period);
    root_ = eigenvalues(covariance, spacing_, period);
  }
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

CirculantAxis::Stencil CirculantAxis::stencil(double x) const {
  if (nodes_ == 1) return {};
  const double position = std::clamp((x - lo_) / spacing_, 0.0, static_cast<double>(nodes_ - 1));
  const std::size_t left = std::min(static_cast<std::size_t>(position), nodes_ - 2);
  const double t = position - static_cast<double>(left);
  return {left, left + 1, 1 - t, t};
}

CirculantEmbedding::CirculantEmbedding(const FieldSpec& spec, Box domain, double dx, Vec2 anchor)
    : x_(axis(domain.lo.x, domain.hi.x, spec.ell_x, spec.along_x(), spec, dx, anchor.x)),
      y_(axis(domain.lo.y, domain.hi.y, spec.ell_y, spec.along_y(), spec, dx, anchor.y)) {
  check_size(static_cast<double>(x_.period()) * static_cast<double>(y_.period()));
}

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
  const auto along_x = [&](const CirculantAxis::Stencil& s, std::size_t j) {
    return s.left_weight * z[j * x_.nodes() + s.left] + s.right_weight * z[j * x_.nodes() + s.right];
  };
  std::vector<double> values;
  values.reserve(points.size());
  for (Vec2 point : points) {
    const auto sx = x_.stencil(point.x), sy = y_.stencil(point.y);
    values.push_back(sy.left_weight * along_x(sx, sy.left) + sy.right_weight * along_x(sx, sy.right));
  }
  return values;
}

}  // namespace talus

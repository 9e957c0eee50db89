#include "random_field/circulant_embedding.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <sstream>
#include <unsupported/Eigen/FFT>

#include "support/error.hpp"

namespace talus {
namespace {

// Parts of a spacing that count as rounding: a point halfway between two nodes, to this tolerance, takes the upper one.
constexpr double rounding = 1e-6;

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

double spacing_along(const FieldSpec& spec, double ell) { return spec.grid_spacing.value_or(grid_fraction * ell); }

double whole_intervals(double length, double spacing) { return std::max(1.0, std::ceil(length / spacing - rounding)); }

/// The spacing u^-1 from which on (x u + 1) (y u + 1) nodes are at most n, for a domain of x by y.
double spacing_that_fits(double x, double y, double n) {
  const double b = x + y;
  return (b + std::sqrt(b * b + 4 * x * y * (n - 1))) / (2 * (n - 1));
}

/// Refuses a domain that takes too many coefficients: twice as many as intervals along each axis.
void check_size(const FieldSpec& spec, Box domain) {
  const double x = spec.along_x() ? domain.width() : 0.0, y = spec.along_y() ? domain.height() : 0.0;
  const double along_x = spec.along_x() ? 2 * whole_intervals(x, spacing_along(spec, spec.ell_x)) : 1.0;
  const double along_y = spec.along_y() ? 2 * whole_intervals(y, spacing_along(spec, spec.ell_y)) : 1.0;
  if (along_x * along_y <= max_grid) return;
  const double fits = spacing_that_fits(x, y, max_grid / (spec.direction == FieldDirection::xy ? 4 : 2));
  std::ostringstream text;
  text.precision(2);
  text << (spec.grid_spacing ? "" : "is missing, and the default, a tenth of the correlation length, ") << "makes "
       << along_x * along_y << " coefficients, more than " << max_grid << "; a spacing from " << 1.05 * fits
       << " m on fits";
  throw ConfigError("/random_field/grid_spacing_m", text.str());
}

CirculantAxis axis(const FieldSpec& spec, Box domain, double dx, bool horizontal) {
  if (!(horizontal ? spec.along_x() : spec.along_y())) return CirculantAxis::constant();
  check_size(spec, domain);
  const ExponentialCovariance covariance{horizontal ? spec.ell_x : spec.ell_y, spec.cell_average ? dx : 0.0};
  const double spacing = spacing_along(spec, covariance.ell);
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
    : lo_(lo), spacing_(spacing), cell_(covariance.cell), variance_(covariance(0)) {
  const ExponentialCovariance of_nodes{covariance.ell};
  correlation_ = of_nodes(spacing);
  nodes_ = static_cast<std::size_t>(whole_intervals(hi - lo, spacing)) + 1;
  root_ = eigenvalues(of_nodes, spacing, fast_length(2 * (nodes_ - 1)));
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

std::size_t CirculantAxis::nearest_node(double x) const {
  const double position = std::floor((x - lo_) / spacing_ + 0.5 + rounding);
  return static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(nodes_ - 1)));
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

CirculantAxis::Stencil CirculantAxis::stencil(double x) const {
  if (nodes_ == 1) return {};
  if (cell_ == 0) return {nearest_node(x), {1.0}};
  const double lo = x - cell_ / 2, hi = x + cell_ / 2;
  const std::size_t first = nearest_node(lo), last = nearest_node(hi);
  Stencil stencil{first, std::vector<double>(last - first + 1)};
  double from = lo;
  for (std::size_t k = first; k <= last; ++k) {
    const double to = k == last ? hi : lo_ + (static_cast<double>(k) + 0.5) * spacing_;
    stencil.weights[k - first] = (to - from) / cell_;
    from = to;
  }
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

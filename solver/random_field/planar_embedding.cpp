#include "random_field/planar_embedding.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unsupported/Eigen/FFT>

#include "support/error.hpp"

namespace talus {
namespace {

/// Negative eigenvalues whose effect on any covariance is below this are rounding [-].
constexpr double rounding_error = 1e-10;
/// By how much periods grow while eigenvalues are negative.
constexpr double growth = 1.3;

using Fft = Eigen::FFT<double>;

/// Transforms every column of a matrix with `width` columns, stored by rows.
template <class Transform>
void for_each_column(std::vector<std::complex<double>>& values, std::size_t width, Transform transform) {
  const std::size_t height = values.size() / width;
  std::vector<std::complex<double>> in(height), out(height);
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t j = 0; j < height; ++j) in[j] = values[j * width + i];
    transform(out, in);
    for (std::size_t j = 0; j < height; ++j) values[j * width + i] = out[j];
  }
}

GridAxis axis_of(const FieldSpec& spec, Box domain, bool horizontal) {
  if (!(horizontal ? spec.along_x() : spec.along_y())) return {};
  check_grid_size(spec, domain);
  return horizontal ? GridAxis(domain.lo.x, domain.hi.x, grid_spacing(spec, spec.ell_x))
                    : GridAxis(domain.lo.y, domain.hi.y, grid_spacing(spec, spec.ell_y));
}

std::size_t lags_within(const GridAxis& axis, double cell) {
  return std::min(axis.nodes(), static_cast<std::size_t>(std::ceil(cell / axis.spacing())) + 2);
}

/// The smallest period of an axis: nodes at opposite ends are nearer to one another along the axis than around it.
std::size_t least_period(const GridAxis& axis) { return axis.nodes() == 1 ? 1 : fast_length(2 * (axis.nodes() - 1)); }

std::size_t grown(std::size_t period) {
  return period == 1 ? 1 : fast_length(static_cast<std::size_t>(growth * static_cast<double>(period)));
}

[[noreturn]] void refuse(double error) {
  std::ostringstream text;
  text.precision(2);
  text << "makes a grid so large that circulant embedding cannot be extended until it is exact: covariances would be "
          "off by up to "
       << error << ", at most " << max_embedding_error
       << " is accepted; a larger spacing, a shorter correlation length or a smaller domain_m gives room";
  throw ConfigError("/random_field/grid_spacing_m", text.str());
}

PeriodicField embed(const Correlation& correlation, const GridAxis& x, const GridAxis& y, double limit) {
  std::size_t period_x = least_period(x), period_y = least_period(y);
  for (;;) {
    PeriodicField field(correlation, {x.spacing(), y.spacing()}, period_x, period_y);
    if (field.error() < rounding_error) return field;
    const std::size_t larger_x = grown(period_x), larger_y = grown(period_y);
    if (static_cast<double>(larger_x) * static_cast<double>(larger_y) > limit) {
      if (field.error() > max_embedding_error) refuse(field.error());
      return field;
    }
    period_x = larger_x;
    period_y = larger_y;
  }
}

/// sum_j w_j w_(j+lag) of a stencil, at each lag.
std::vector<double> autocorrelation(const std::vector<double>& w) {
  std::vector<double> sums(w.size());
  for (std::size_t lag = 0; lag < w.size(); ++lag)
    for (std::size_t j = 0; j + lag < w.size(); ++j) sums[lag] += (lag == 0 ? 1 : 2) * w[j] * w[j + lag];
  return sums;
}

}  // namespace

PeriodicField::PeriodicField(const Correlation& correlation, Vec2 spacing, std::size_t period_x, std::size_t period_y,
                             Spectrum spectrum)
    : period_x_(period_x), period_y_(period_y) {
  std::vector<double> row(period_x * period_y);
  for (std::size_t j = 0; j < period_y; ++j)
    for (std::size_t i = 0; i < period_x; ++i)
      row[j * period_x + i] = correlation({static_cast<double>(std::min(i, period_x - i)) * spacing.x,
                                           static_cast<double>(std::min(j, period_y - j)) * spacing.y});
  const Transform eigen = transform(row);
  for (const std::complex<double>& value : eigen) factors_.push_back(value.real());
  if (spectrum == Spectrum::signed_eigenvalues) return;
  double negative = 0;
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    const std::size_t i = k % half();
    const bool own_mirror = i == 0 || 2 * i == period_x;
    negative += (own_mirror ? 1 : 2) * std::max(-factors_[k], 0.0);
  }
  negative /= static_cast<double>(period_x * period_y);  // the variance that setting them to zero adds
  for (double& value : factors_) value = std::sqrt(std::max(value, 0.0) / (1 + negative));
  error_ = 2 * negative;
}

PeriodicField::Transform PeriodicField::transform(std::span<const double> values) const {
  Fft fft;
  fft.SetFlag(Fft::HalfSpectrum);
  Transform spectrum(half() * period_y_);
  for (std::size_t j = 0; j < period_y_; ++j) {
    if (period_x_ == 1)
      spectrum[j] = values[j];
    else
      fft.fwd(&spectrum[j * half()], &values[j * period_x_], static_cast<Eigen::Index>(period_x_));
  }
  if (period_y_ > 1)
    for_each_column(spectrum, half(), [&](auto& out, const auto& in) {
      fft.fwd(out.data(), in.data(), static_cast<Eigen::Index>(period_y_));
    });
  return spectrum;
}

void PeriodicField::filter(std::span<double> values) const {
  Transform spectrum = transform(values);
  for (std::size_t k = 0; k < spectrum.size(); ++k) spectrum[k] *= factors_[k];
  Fft fft;
  fft.SetFlag(Fft::HalfSpectrum);
  if (period_y_ > 1)
    for_each_column(spectrum, half(), [&](auto& out, const auto& in) {
      fft.inv(out.data(), in.data(), static_cast<Eigen::Index>(period_y_));
    });
  for (std::size_t j = 0; j < period_y_; ++j) {
    if (period_x_ == 1)
      values[j] = spectrum[j].real();
    else
      fft.inv(&values[j * period_x_], &spectrum[j * half()], static_cast<Eigen::Index>(period_x_));
  }
}

PlanarEmbedding::PlanarEmbedding(const FieldSpec& spec, Box domain, double dx, double limit)
    : correlation_(spec),
      cell_(spec.cell_average ? dx : 0.0),
      variance_(correlation_.cell_variance(cell_)),
      x_(axis_of(spec, domain, true)),
      y_(axis_of(spec, domain, false)),
      lags_x_(lags_within(x_, cell_)),
      lags_y_(lags_within(y_, cell_)),
      periodic_(embed(correlation_, x_, y_, limit)) {
  for (std::size_t j = 0; j < lags_y_; ++j)
    for (std::size_t i = 0; i < lags_x_; ++i)
      correlations_.push_back(
          correlation_({static_cast<double>(i) * x_.spacing(), static_cast<double>(j) * y_.spacing()}));
}

/// Variance of a weighted sum over nodes: sum over lags of the stencils' autocorrelations times the correlation.
double PlanarEmbedding::variance_of(const Stencil& x, const Stencil& y) const {
  const std::vector<double> along_x = autocorrelation(x.weights), along_y = autocorrelation(y.weights);
  double sum = 0;
  for (std::size_t j = 0; j < along_y.size(); ++j)
    for (std::size_t i = 0; i < along_x.size(); ++i) sum += along_x[i] * along_y[j] * correlations_[j * lags_x_ + i];
  return sum;
}

std::vector<double> PlanarEmbedding::gaussian(std::span<const Vec2> points, std::span<const double> xi) const {
  std::vector<double> z(xi.begin(), xi.end());
  periodic_.filter(z);
  std::vector<double> values;
  values.reserve(points.size());
  for (const Vec2 point : points) {
    const Stencil x = x_.stencil(point.x, cell_), y = y_.stencil(point.y, cell_);
    double sum = 0;
    for (std::size_t j = 0; j < y.weights.size(); ++j)
      for (std::size_t i = 0; i < x.weights.size(); ++i)
        sum += y.weights[j] * x.weights[i] * z[(y.first + j) * periodic_.period_x() + x.first + i];
    values.push_back(cell_ == 0 ? sum : sum * std::sqrt(variance_ / variance_of(x, y)));
  }
  return values;
}

}  // namespace talus

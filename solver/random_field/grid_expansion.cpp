#include "random_field/grid_expansion.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>
#include <utility>

#include "random_field/planar_embedding.hpp"
#include "random_field/stream.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Cells of the grid along an axis, as a fraction of the correlation length; larger ones where the grid would have more
/// nodes than there are for `nodes_per_mode` for each mode.
constexpr double cell_fraction = 0.1;
constexpr double nodes_per_mode = 40, least_nodes = 2'000, max_nodes = 10'000;
/// Modes computed beyond those kept: a constant and a part of them. They make the last ones kept converge.
constexpr Eigen::Index more_modes = 20, part_more = 4;
/// Products with the covariance after the first one.
constexpr int iterations = 2;
/// Modes tried first where a share of the variance is asked for; doubled until they carry it.
constexpr Eigen::Index first_try = 32;

/// Axes whose nodes are the middles of equal cells of the domain.
std::pair<GridAxis, GridAxis> axes_over(const FieldSpec& spec, Box domain) {
  double nx = spec.along_x() ? std::max(1.0, std::ceil(domain.width() / (cell_fraction * spec.ell_x))) : 1.0;
  double ny = spec.along_y() ? std::max(1.0, std::ceil(domain.height() / (cell_fraction * spec.ell_y))) : 1.0;
  const double modes = spec.truncation == Truncation::variance_share ? max_grid_modes : spec.terms;
  const double most = std::clamp(nodes_per_mode * modes, least_nodes, max_nodes);
  if (nx * ny > most) {  // coarser by one factor along both axes, as far as each has cells
    double& fewer = nx < ny ? nx : ny;
    double& more = nx < ny ? ny : nx;
    fewer = std::max(1.0, std::floor(fewer * std::sqrt(most / (nx * ny))));
    more = std::floor(std::min(more, most / fewer));
  }
  return {GridAxis::middles(domain.lo.x, domain.hi.x, static_cast<std::size_t>(nx)),
          GridAxis::middles(domain.lo.y, domain.hi.y, static_cast<std::size_t>(ny))};
}

/// The covariance matrix of the nodes, as a block of a circulant one.
class GridCovariance {
 public:
  GridCovariance(const Correlation& correlation, const GridAxis& x, const GridAxis& y)
      : nx_(x.nodes()),
        ny_(y.nodes()),
        periodic_(correlation, {x.spacing(), y.spacing()}, nx_ == 1 ? 1 : fast_length(2 * (nx_ - 1)),
                  ny_ == 1 ? 1 : fast_length(2 * (ny_ - 1)), PeriodicField::Spectrum::signed_eigenvalues) {}

  Eigen::Index nodes() const { return static_cast<Eigen::Index>(nx_ * ny_); }

  /// Every column of a matrix times the covariance.
  Eigen::MatrixXd times(const Eigen::MatrixXd& vectors) const {
    Eigen::MatrixXd out(vectors.rows(), vectors.cols());
    std::vector<double> padded(periodic_.period_x() * periodic_.period_y());
    for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
      std::ranges::fill(padded, 0.0);
      for (std::size_t j = 0; j < ny_; ++j)
        std::copy_n(vectors.col(k).data() + j * nx_, nx_, padded.data() + j * periodic_.period_x());
      periodic_.filter(padded);
      for (std::size_t j = 0; j < ny_; ++j)
        std::copy_n(padded.data() + j * periodic_.period_x(), nx_, out.col(k).data() + j * nx_);
    }
    return out;
  }

 private:
  std::size_t nx_, ny_;
  PeriodicField periodic_;
};

/// Leading eigenvectors of unit norm, in order of falling eigenvalue.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& vectors) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(vectors).householderQ() *
         Eigen::MatrixXd::Identity(vectors.rows(), vectors.cols());
}

/// The entry of the largest magnitude of every vector becomes positive.
void fix_signs(Eigen::MatrixXd& vectors) {
  for (auto column : vectors.colwise()) {
    Eigen::Index largest = 0;
    column.cwiseAbs().maxCoeff(&largest);
    if (column[largest] < 0) column = -column;
  }
}

Eigenpairs leading(const GridCovariance& covariance, Eigen::Index count) {
  const Eigen::Index n = covariance.nodes();
  const Eigen::Index size = std::min(n, count + count / part_more + more_modes);
  Eigen::MatrixXd basis(n, size);
  for (Eigen::Index k = 0; k < size; ++k)
    for (Eigen::Index i = 0; i < n; ++i)
      basis(i, k) =
          uniforms(0, static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(k), Stream::subspace)[0] - 0.5;
  for (int i = 0; i < iterations; ++i) basis = orthonormal(covariance.times(basis));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(basis.transpose() * covariance.times(basis));
  count = std::min(count, n);
  Eigenpairs pairs{ritz.eigenvalues().reverse().head(count).cwiseMax(0.0),
                   basis * ritz.eigenvectors().rowwise().reverse().leftCols(count)};
  fix_signs(pairs.vectors);
  return pairs;
}

[[noreturn]] void refuse_share(double share, double reached) {
  std::ostringstream text;
  text << "a share of " << share << " takes more than " << max_grid_modes << " modes, which carry " << reached
       << "; ask for less, or for circulant embedding, which truncates nothing";
  throw ConfigError("/random_field/variance_share", text.str());
}

/// As few of the leading ones as carry the share of the variance.
Eigenpairs reaching(const GridCovariance& covariance, double share) {
  const double whole = static_cast<double>(covariance.nodes());
  constexpr auto most = static_cast<Eigen::Index>(max_grid_modes);
  for (Eigen::Index count = first_try;; count = std::min(2 * count, most)) {
    Eigenpairs pairs = leading(covariance, count);
    double sum = 0;
    for (Eigen::Index k = 0; k < pairs.values.size(); ++k) {
      sum += pairs.values[k];
      if (sum < share * whole) continue;
      return {pairs.values.head(k + 1), pairs.vectors.leftCols(k + 1)};
    }
    if (count >= std::min(most, covariance.nodes())) refuse_share(share, sum / whole);
  }
}

Eigenpairs truncated(const FieldSpec& spec, const GridCovariance& covariance) {
  if (spec.truncation == Truncation::variance_share) return reaching(covariance, spec.variance_share);
  if (static_cast<std::size_t>(spec.terms) > max_grid_modes)
    throw ConfigError("/random_field/terms", "is " + std::to_string(spec.terms) + "; at most " +
                                                 std::to_string(max_grid_modes) +
                                                 " are possible with this covariance; circulant_embedding truncates "
                                                 "nothing");
  return leading(covariance, spec.terms);
}

/// Calls use(node, weight) for the nodes of two stencils.
template <class Use>
void for_each_node(const Stencil& x, const Stencil& y, std::size_t nx, Use use) {
  for (std::size_t j = 0; j < y.weights.size(); ++j)
    for (std::size_t i = 0; i < x.weights.size(); ++i)
      use(static_cast<Eigen::Index>((y.first + j) * nx + x.first + i), y.weights[j] * x.weights[i]);
}

}  // namespace

GridExpansion::GridExpansion(const FieldSpec& spec, Box domain, double dx) : cell_(spec.cell_average ? dx : 0.0) {
  std::tie(x_, y_) = axes_over(spec, domain);
  const GridCovariance covariance(Correlation(spec), x_, y_);
  Eigenpairs pairs = truncated(spec, covariance);
  for (const double value : pairs.values) shares_.push_back(value / static_cast<double>(covariance.nodes()));
  modes_ = pairs.vectors * pairs.values.cwiseSqrt().asDiagonal();
  variance_ = mean_variance();
}

GridExpansion GridExpansion::at_points() const {
  GridExpansion same = *this;
  same.cell_ = 0;
  same.variance_ = same.mean_variance();
  return same;
}

/// Two Gauss points a side of the squares between nodes: exact for the square of a function that is linear there.
double GridExpansion::mean_variance() const {
  const double offset = 0.5 - std::sqrt(1.0 / 12.0);
  std::vector<Vec2> points;
  for (std::size_t j = 0; j < y_.nodes(); ++j)
    for (std::size_t i = 0; i < x_.nodes(); ++i)
      for (const double v : {-offset, offset})
        for (const double u : {-offset, offset})
          points.push_back({x_.at(i) + u * x_.spacing(), y_.at(j) + v * y_.spacing()});
  const std::vector<double> all = variance(points);
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

double GridExpansion::captured_variance() const {
  return std::min(1.0, std::accumulate(shares_.begin(), shares_.end(), 0.0));
}

std::vector<double> GridExpansion::modes_at(Vec2 point) const {
  std::vector<double> f(terms());
  for_each_node(along(x_, point.x), along(y_, point.y), x_.nodes(), [&](Eigen::Index node, double weight) {
    for (std::size_t k = 0; k < f.size(); ++k) f[k] += weight * modes_(node, static_cast<Eigen::Index>(k));
  });
  return f;
}

std::vector<double> GridExpansion::variance(std::span<const Vec2> points) const {
  std::vector<double> v;
  v.reserve(points.size());
  for (const Vec2 point : points) {
    const std::vector<double> f = modes_at(point);
    v.push_back(std::inner_product(f.begin(), f.end(), f.begin(), 0.0));
  }
  return v;
}

std::vector<double> GridExpansion::gaussian(std::span<const Vec2> points, std::span<const double> xi) const {
  const Eigen::VectorXd on_nodes =
      modes_ * Eigen::Map<const Eigen::VectorXd>(xi.data(), static_cast<Eigen::Index>(xi.size()));
  std::vector<double> z;
  z.reserve(points.size());
  for (const Vec2 point : points) {
    double sum = 0;
    for_each_node(along(x_, point.x), along(y_, point.y), x_.nodes(),
                  [&](Eigen::Index node, double weight) { sum += weight * on_nodes[node]; });
    z.push_back(sum);
  }
  return z;
}

}  // namespace talus

#include "random_field/random_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "random_field/stream.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

Box checked(const FieldSpec& spec, Box domain) {
  if (spec.along_x() && !(domain.width() > 0)) throw ConfigError("/random_field/domain_m", "has no extent along x");
  if (spec.along_y() && !(domain.height() > 0)) throw ConfigError("/random_field/domain_m", "has no extent along y");
  return domain;
}

FieldSpec without_averaging(FieldSpec spec) {
  spec.cell_average = false;
  return spec;
}

}  // namespace

RandomField::Sampler RandomField::make_sampler(const FieldSpec& spec, Box domain, double dx) {
  const bool closed_form = spec.covariance == Covariance::exponential;
  if (spec.sampler == FieldSampler::karhunen_loeve) {
    if (closed_form) return KarhunenLoeve(spec, domain, dx);
    return GridExpansion(spec, domain, dx);
  }
  if (closed_form) return CirculantEmbedding(spec, domain, dx);
  return PlanarEmbedding(spec, domain, dx);
}

RandomField::RandomField(const FieldSpec& spec, Box slide_box, double dx)
    : correlation_(spec),
      bedding_(spec.dip),
      nugget_(spec.nugget),
      cell_(spec.cell_average ? dx : 0.0),
      sampler_(make_sampler(spec, bedding_.around(checked(spec, spec.domain.value_or(slide_box))), dx)),
      spec_(spec),
      domain_(bedding_.around(spec.domain.value_or(slide_box))) {
  if (cell_ > 0) {
    const auto* expansion = std::get_if<GridExpansion>(&sampler_);
    at_points_.emplace(expansion ? Sampler(expansion->at_points())
                                 : make_sampler(without_averaging(spec_), domain_, 0.0));
  }
  if (spec.data.empty()) check_given(terms());
}

void RandomField::check_given(std::size_t needed) const {
  if (spec_.xi.empty() || spec_.xi.size() == needed) return;
  throw ConfigError("/random_field/xi", "has " + std::to_string(spec_.xi.size()) + " coefficients, the field takes " +
                                            std::to_string(needed));
}

void RandomField::condition(std::span<const GaussianDatum> data) {
  if (data.empty()) return;
  std::vector<GaussianDatum> turned = merged(data);
  data_points_.clear();
  for (GaussianDatum& datum : turned) {
    data_points_.push_back(datum.x);
    datum.x = bedding_.turned(datum.x);
  }
  conditioning_.emplace(correlation_, nugget_, std::move(turned));
  check_given(terms());
}

double RandomField::embedding_error() const {
  const auto* planar = std::get_if<PlanarEmbedding>(&sampler_);
  return planar == nullptr ? 0.0 : planar->error();
}

std::vector<double> RandomField::variance(std::span<const Vec2> points) const {
  const std::vector<Vec2> turned = bedding_.turned(points);
  std::vector<double> v = std::visit([&](const auto& s) { return s.variance(turned); }, sampler_);
  for (double& value : v) value = with_nugget(value);
  return v;
}

std::vector<double> RandomField::averaging_loss(std::span<const Vec2> points) const {
  std::vector<double> loss(points.size(), 0.0);
  if (!at_points_) return loss;
  const std::vector<double> averaged = sampled_variance(points, Support::cell);
  const std::vector<double> at = sampled_variance(points, Support::point);
  for (std::size_t i = 0; i < loss.size(); ++i) loss[i] = at[i] - averaged[i];
  return loss;
}

double RandomField::averaging() const {
  const auto variance_of = [](const Sampler& sampler) {
    return std::visit([](const auto& s) { return s.variance(); }, sampler);
  };
  return at_points_ ? std::min(1.0, variance_of(sampler_) / variance_of(*at_points_)) : 1.0;
}

std::vector<double> RandomField::sampled(std::span<const Vec2> points, std::span<const double> xi,
                                         Support support) const {
  const std::vector<Vec2> turned = bedding_.turned(points);
  const auto draw = [&](const auto& s) { return s.gaussian(turned, xi.first(s.terms())); };
  std::vector<double> y = std::visit(draw, sampler(support));
  if (nugget_ > 0)
    for (double& value : y) value *= std::sqrt(1 - nugget_);
  return y;
}

std::vector<double> RandomField::sampled_variance(std::span<const Vec2> points, Support support) const {
  const std::vector<Vec2> turned = bedding_.turned(points);
  std::vector<double> v = std::visit([&](const auto& s) { return s.variance(turned); }, sampler(support));
  for (double& value : v) value *= 1 - nugget_;
  return v;
}

Eigen::MatrixXd RandomField::sampled_covariances(std::span<const Vec2> points, std::span<const Vec2> places,
                                                 Support support) const {
  const std::vector<Vec2> turned = bedding_.turned(points);
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd c(static_cast<Eigen::Index>(places.size()), count);
  const auto fill = [&]<class S>(const S& of_support) {
    for (Eigen::Index i = 0; i < c.rows(); ++i) {
      const Vec2 place = bedding_.turned(places[static_cast<std::size_t>(i)]);
      if constexpr (requires { of_support.modes_at(Vec2{}); }) {  // what is drawn has the covariances of the modes kept
        const std::vector<double> at = std::get<S>(sampler(Support::point)).modes_at(place);
        const std::vector<double> row = of_support.gaussian(turned, at);
        c.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), count);
      } else {
        const double cell = support == Support::cell ? cell_ : 0.0;
        for (Eigen::Index k = 0; k < count; ++k)
          c(i, k) = correlation_.with_cell(turned[static_cast<std::size_t>(k)] - place, cell);
      }
    }
  };
  std::visit(fill, sampler(support));
  return (1 - nugget_) * c;
}

std::vector<double> RandomField::conditional_variance(std::span<const Vec2> points) const {
  std::vector<double> v = variance(points);
  if (!conditioning_) return v;
  const Eigen::MatrixXd of_data = sampled_covariances(data_points_, data_points_, Support::point);
  const Eigen::MatrixXd with_data = sampled_covariances(points, data_points_, Support::cell);
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Eigen::VectorXd kriging = conditioning_->covariances(bedding_.turned(points[k]), cell_);
    v[k] = nugget_ + std::max(0.0, conditioning_->variance(kriging, v[k] - nugget_,
                                                           with_data.col(static_cast<Eigen::Index>(k)), of_data));
  }
  return v;
}

std::vector<double> RandomField::draw(std::uint64_t seed, std::uint64_t realization) const {
  if (!spec_.xi.empty()) return spec_.xi;
  std::vector<double> xi(terms());
  for (std::size_t k = 0; k < xi.size(); ++k) xi[k] = standard_normal(seed, realization, static_cast<std::uint32_t>(k));
  return xi;
}

std::vector<double> RandomField::draw_stratified(std::uint64_t seed, std::uint64_t realizations,
                                                 std::uint64_t realization, std::size_t modes) const {
  std::vector<double> xi = draw(seed, realization);
  if (!spec_.xi.empty()) return xi;
  const auto leading = stratified_normals(seed, realizations, realization, std::min(modes, xi.size()));
  std::copy(leading.begin(), leading.end(), xi.begin());
  return xi;
}

std::vector<double> RandomField::gaussian(std::span<const Vec2> points, std::span<const double> xi) const {
  if (xi.size() != terms()) throw std::invalid_argument("RandomField::gaussian: xi does not have terms() entries");
  std::vector<double> z = sampled(points, xi, Support::cell);
  if (conditioning_) {
    const std::vector<double> y = sampled(data_points_, xi, Support::point);
    const Eigen::VectorXd a = conditioning_->coefficients(y, xi.subspan(modes(), data()));
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += conditioning_->correction(bedding_.turned(points[i]), cell_, a);
  }
  if (nugget_ > 0)
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += std::sqrt(nugget_) * white_noise(xi.back(), points[i]);
  return z;
}

double log_stdev(double cov) { return std::sqrt(std::log1p(cov * cov)); }

double coefficient_of_variation(double sigma, double variance) {
  return std::sqrt(std::expm1(sigma * sigma * variance));
}

std::vector<double> log_medians(double mean, double sigma, std::span<const double> variance) {
  std::vector<double> mu;
  mu.reserve(variance.size());
  for (double v : variance) mu.push_back(std::log(mean) - sigma * sigma * v / 2);
  return mu;
}

double log_trend(double tan_phi, double slope, double depth) {
  return std::log(std::tan(std::atan(tan_phi) + slope * depth) / tan_phi);
}

std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma) {
  if (mu.size() != 1 && mu.size() != gaussian.size())
    throw std::invalid_argument("lognormal: mu is one value, or one per point");
  std::vector<double> value(gaussian.size());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::exp(mu[mu.size() == 1 ? 0 : i] + sigma * gaussian[i]);
  return value;
}

}  // namespace talus

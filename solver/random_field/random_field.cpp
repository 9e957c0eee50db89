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

using Sampler = std::variant<KarhunenLoeve, CirculantEmbedding>;

Sampler make_sampler(const FieldSpec& spec, Box slide_box, double dx) {
  const Box domain = spec.domain.value_or(slide_box);
  if (spec.along_x() && !(domain.width() > 0)) throw ConfigError("/random_field/domain_m", "has no extent along x");
  if (spec.along_y() && !(domain.height() > 0)) throw ConfigError("/random_field/domain_m", "has no extent along y");
  if (spec.sampler == FieldSampler::karhunen_loeve) return KarhunenLoeve(spec, domain, dx);
  return CirculantEmbedding(spec, domain, dx);
}

}  // namespace

RandomField::RandomField(const FieldSpec& spec, Box slide_box, double dx)
    : sampler_(make_sampler(spec, slide_box, dx)), given_(spec.xi) {
  if (given_.empty() || given_.size() == terms()) return;
  throw ConfigError("/random_field/xi", "has " + std::to_string(given_.size()) + " coefficients, the field takes " +
                                            std::to_string(terms()));
}

std::vector<double> RandomField::draw(std::uint64_t seed, std::uint64_t realization) const {
  if (!given_.empty()) return given_;
  std::vector<double> xi(terms());
  for (std::size_t k = 0; k < xi.size(); ++k) xi[k] = standard_normal(seed, realization, static_cast<std::uint32_t>(k));
  return xi;
}

std::vector<double> RandomField::draw_stratified(std::uint64_t seed, std::uint64_t realizations,
                                                 std::uint64_t realization, std::size_t modes) const {
  std::vector<double> xi = draw(seed, realization);
  if (!given_.empty()) return xi;
  const auto leading = stratified_normals(seed, realizations, realization, std::min(modes, xi.size()));
  std::copy(leading.begin(), leading.end(), xi.begin());
  return xi;
}

std::vector<double> RandomField::gaussian(std::span<const Vec2> points, std::span<const double> xi) const {
  if (xi.size() != terms()) throw std::invalid_argument("RandomField::gaussian: xi does not have terms() entries");
  return std::visit([&](const auto& sampler) { return sampler.gaussian(points, xi); }, sampler_);
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

std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma) {
  if (mu.size() != 1 && mu.size() != gaussian.size())
    throw std::invalid_argument("lognormal: mu is one value, or one per point");
  std::vector<double> value(gaussian.size());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::exp(mu[mu.size() == 1 ? 0 : i] + sigma * gaussian[i]);
  return value;
}

}  // namespace talus

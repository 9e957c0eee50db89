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

bool positive(double value) { return std::isfinite(value) && value > 0; }

/// Every fault of a specification that the samplers could not work with.
std::vector<Fault> faults(const FieldSpec& spec, Box domain, double dx) {
  const bool along_x = spec.along_x(), along_y = spec.along_y();
  const bool karhunen_loeve = spec.sampler == FieldSampler::karhunen_loeve;
  const bool by_share = spec.truncation == Truncation::variance_share;
  std::vector<Fault> all;
  const auto require = [&](bool holds, const char* pointer, std::string message) {
    if (!holds) all.push_back({std::string("/random_field") + pointer, std::move(message)});
  };
  require(!along_x || positive(spec.ell_x), "/correlation_length_x_m", "must be positive");
  require(!along_y || positive(spec.ell_y), "/correlation_length_y_m", "must be positive");
  require(!along_x || positive(domain.width()), "/domain_m", "has no extent along x");
  require(!along_y || positive(domain.height()), "/domain_m", "has no extent along y");
  require(!karhunen_loeve || by_share || (spec.terms >= 1 && std::cmp_less_equal(spec.terms, max_modes)), "/terms",
          "must be in 1 .. " + std::to_string(max_modes));
  require(!karhunen_loeve || !by_share || (spec.variance_share > 0 && spec.variance_share < 1), "/variance_share",
          "must be greater than 0 and less than 1");
  require(!spec.grid_spacing || positive(*spec.grid_spacing), "/grid_spacing_m", "must be positive");
  const bool needs_dx = spec.cell_average || (!karhunen_loeve && !spec.grid_spacing);
  require(!needs_dx || positive(dx), "", "needs a positive particle spacing");
  return all;
}

Sampler make_sampler(const FieldSpec& spec, Box slide_box, double dx) {
  const Box domain = spec.domain.value_or(slide_box);
  if (auto all = faults(spec, domain, dx); !all.empty()) throw ConfigError(std::move(all));
  if (spec.sampler == FieldSampler::karhunen_loeve) return KarhunenLoeve(spec, domain, dx);
  return CirculantEmbedding(spec, domain, dx, slide_box.lo);
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

LogParameters log_parameters(Moments moments) {
  const double variance = std::log1p(moments.cov * moments.cov);
  return {.mu = std::log(moments.mean) - variance / 2, .sigma = std::sqrt(variance)};
}

std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma) {
  if (mu.size() != 1 && mu.size() != gaussian.size())
    throw std::invalid_argument("lognormal: mu is one value, or one per point");
  std::vector<double> value(gaussian.size());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::exp(mu[mu.size() == 1 ? 0 : i] + sigma * gaussian[i]);
  return value;
}

}  // namespace talus

#pragma once
// Random fields of tan(phi): [Z20] Eqs. 11-23. Knows no particle, maps points to values.

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/circulant_embedding.hpp"
#include "random_field/field_spec.hpp"
#include "random_field/karhunen_loeve.hpp"

namespace talus {

/// A standard Gaussian field Z(x) prepared for sampling: modes solved (Karhunen-Loeve) or spectrum known (circulant
/// embedding).
class RandomField {
 public:
  /// @param spec       what is asked for, within the ranges of its members; `spec.domain` overrides `slide_box`
  /// @param slide_box  bounding box of the slide [m]
  /// @param dx         particle spacing [m], side of the cells that `cell_average` averages over
  /// @throws ConfigError (pointer under /random_field) when the domain has no extent or the embedding is impossible
  RandomField(const FieldSpec& spec, Box slide_box, double dx);

  /// Number of standard normal coefficients xi that a sample takes.
  std::size_t terms() const {
    return std::visit([](const auto& s) { return s.terms(); }, sampler_);
  }
  /// Share of the field's variance that the modes carry, averaged over the domain, in (0, 1]; 1 for circulant embedding
  /// [- , Karhunen-Loeve: sum lambda / (2 a_x 2 a_y)].
  double captured_variance() const {
    return std::visit([](const auto& s) { return s.captured_variance(); }, sampler_);
  }
  /// Variance of the values that gaussian() returns, averaged over the domain [-]: captured_variance() less what
  /// `cell_average` takes away.
  double variance() const {
    return std::visit([](const auto& s) { return s.variance(); }, sampler_);
  }
  /// Variance of the values that gaussian() returns at points [-], shape of `points`. It takes as long as gaussian().
  std::vector<double> variance(std::span<const Vec2> points) const {
    return std::visit([&](const auto& s) { return s.variance(points); }, sampler_);
  }
  /// Coefficients of one realization: counter-based (Philox), keyed by (seed, realization, mode); never depend on
  /// anything else. With `spec.xi`, those.
  std::vector<double> draw(std::uint64_t seed, std::uint64_t realization) const;
  /// The same with the `modes` leading coefficients (or all, if there are fewer) from a Latin hypercube sample of
  /// `realizations` realizations. Of use for Karhunen-Loeve, whose leading modes carry most; harmless else.
  std::vector<double> draw_stratified(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization,
                                      std::size_t modes) const;
  /// Z at points [-]; `xi` has terms() entries (else std::invalid_argument). Points outside the domain take the modes'
  /// analytic continuation; with circulant embedding the value at the grid's nearest node. Safe to call from several
  /// threads at once.
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

 private:
  std::variant<KarhunenLoeve, CirculantEmbedding> sampler_;
  std::vector<double> given_;  ///< coefficients that the specification gives; empty: drawn
};

/// Standard deviation of the logarithm of a lognormal quantity [-]: sigma^2 = ln(1 + COV^2). ([Z20] Table 4 calls
/// sigma/|mu| the COV; that is another number.)
/// @param cov  coefficient of variation, standard deviation / mean [-], >= 0
double log_stdev(double cov);

/// Coefficient of variation of exp(mu + sigma Z) [-] for a Z of that variance: sqrt(exp(sigma^2 V) - 1).
double coefficient_of_variation(double sigma, double variance);

/// mu = ln(mean) - sigma^2 V / 2 at each point, so that exp(mu + sigma Z) has the mean asked for whatever the variance
/// V of Z there: 1 for the whole field, less where it is truncated or averaged.
/// @param mean      mean of tan(phi) [-], > 0
/// @param variance  V at each point [-]
std::vector<double> log_medians(double mean, double sigma, std::span<const double> variance);

/// tan(phi) = exp(mu + sigma Z). [Z20] Eq. 12; mu is a value for every point, or one for all.
std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma);

}  // namespace talus

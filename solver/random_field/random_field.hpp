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
  /// @param spec       what is asked for; `spec.domain` overrides `slide_box`
  /// @param slide_box  bounding box of the slide [m]
  /// @param dx      particle spacing [m], for `cell_average` and the default grid
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
  /// `cell_average` takes away; circulant embedding: on the nodes of its grid.
  double variance() const {
    return std::visit([](const auto& s) { return s.variance(); }, sampler_);
  }
  /// Coefficients of one realization: counter-based (Philox), keyed by (seed, realization, mode); never depend on
  /// anything else. With `spec.xi`, those.
  std::vector<double> draw(std::uint64_t seed, std::uint64_t realization) const;
  /// The same with the `modes` leading coefficients (or all, if there are fewer) from a Latin hypercube sample of
  /// `realizations` realizations. Of use for Karhunen-Loeve, whose leading modes carry most; harmless else.
  std::vector<double> draw_stratified(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization,
                                      std::size_t modes) const;
  /// Z at points [-]; `xi` has terms() entries (else std::invalid_argument). Points outside the domain take the modes'
  /// analytic continuation; with circulant embedding the value at the grid's nearest point. Safe to call from several
  /// threads at once.
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

 private:
  std::variant<KarhunenLoeve, CirculantEmbedding> sampler_;
  std::vector<double> given_;  ///< coefficients that the specification gives; empty: drawn
};

/// Mean and standard deviation of the logarithm.
struct LogParameters {
  double mu;     ///< mean of ln(tan phi) [-]; exp(mu) is the median of tan(phi)
  double sigma;  ///< standard deviation of ln(tan phi) [-], >= 0
};

/// Mean and coefficient of variation of the quantity itself.
struct Moments {
  double mean;  ///< [-], > 0
  double cov;   ///< standard deviation / mean [-], >= 0
};

/// sigma^2 = ln(1 + COV^2), mu = ln(mean) - sigma^2/2. ([Z20] Table 4 calls sigma/|mu| the COV; that is another
/// number.)
LogParameters log_parameters(Moments moments);

/// tan(phi) = exp(mu + sigma Z). [Z20] Eq. 12; mu is a value for every point, or one for all.
std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma);

}  // namespace talus

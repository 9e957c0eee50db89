#pragma once
// Random fields of tan(phi): [Z20] Eqs. 11-23. Knows no particle, maps points to values.

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "math/vec2.hpp"
#include "random_field/bedding.hpp"
#include "random_field/circulant_embedding.hpp"
#include "random_field/conditioning.hpp"
#include "random_field/covariance.hpp"
#include "random_field/field_spec.hpp"
#include "random_field/grid_expansion.hpp"
#include "random_field/karhunen_loeve.hpp"
#include "random_field/planar_embedding.hpp"

namespace talus {

/// What a value of the field stands for: the mean over a particle's cell (the point, where the field is not averaged),
/// or the point itself.
enum class Support { cell, point };

/// A standard Gaussian field Z(x) prepared for sampling: modes solved (truncated expansions) or spectrum known
/// (circulant embedding); conditioned on data where there are any.
///
/// Z = Y + sqrt(nugget) W: Y of covariance (1 - nugget) rho from the sampler, W white noise of the particles. The
/// coefficients xi are those of the sampler, then one per datum (the error of this realization), then one that selects
/// the noise W. Safe to use from several threads at once, condition() excepted.
class RandomField {
 public:
  /// @param spec       what is asked for, within the ranges of its members; `spec.domain` overrides `slide_box`.
  ///                   `spec.data` are not used here: their values on the scale of Z are for condition()
  /// @param slide_box  bounding box of the slide [m]
  /// @param dx         particle spacing [m], side of the cells that `cell_average` averages over
  /// @throws ConfigError (pointer under /random_field) when the domain has no extent or the embedding is impossible
  RandomField(const FieldSpec& spec, Box slide_box, double dx);

  /// Makes the field meet data, each within its error. Data at one point are merged.
  /// @throws ConfigError (/random_field/data) when no field of the covariance meets them
  void condition(std::span<const GaussianDatum> data);

  /// Number of standard normal coefficients xi that a sample takes.
  std::size_t terms() const { return modes() + data() + (nugget_ > 0 ? 1 : 0); }
  /// Number of coefficients of the sampler, which come first.
  std::size_t modes() const {
    return std::visit([](const auto& s) { return s.terms(); }, sampler_);
  }
  /// Number of points with data, each of which has a coefficient.
  std::size_t data() const { return conditioning_ ? conditioning_->size() : 0; }
  /// Share of the variance of the field without data that is drawn, averaged over the domain, in (0, 1]; 1 for
  /// circulant embedding [-, Karhunen-Loeve: sum lambda / (2 a_x 2 a_y)]. With a dip, the domain is the rectangle along
  /// the bedding around the one that is asked for.
  double captured_variance() const { return with_nugget(captured()); }
  /// Bound of the error of any covariance that circulant embedding makes [-]; 0 for expansions, which truncate instead.
  double embedding_error() const;
  /// Variance of the values that gaussian() returns without data, averaged over the domain [-]: captured_variance()
  /// less what `cell_average` takes away.
  double variance() const {
    return with_nugget(std::visit([](const auto& s) { return s.variance(); }, sampler_));
  }
  /// Variance without data of the values that gaussian() returns at points [-], shape of `points`. The mean and the
  /// coefficient of variation that a case asks for are those of the soil before the data are known, so the marginal at
  /// a point follows from this variance, with data too. It takes as long as gaussian().
  std::vector<double> variance(std::span<const Vec2> points) const;
  /// What averaging over cells takes from the variance at points [-], shape of `points`; 0 without averaging.
  std::vector<double> averaging_loss(std::span<const Vec2> points) const;
  /// Variance of the values that gaussian() returns at points [-], given the data; without data that of variance().
  /// Their mean is gaussian() with every coefficient 0.
  std::vector<double> conditional_variance(std::span<const Vec2> points) const;
  /// Coefficients of one realization: counter-based (Philox), keyed by (seed, realization, mode); never depend on
  /// anything else. With `spec.xi`, those.
  std::vector<double> draw(std::uint64_t seed, std::uint64_t realization) const;
  /// The same with the `modes` leading coefficients (or all, if there are fewer) from a Latin hypercube sample of
  /// `realizations` realizations. Of use for Karhunen-Loeve, whose leading modes carry most; harmless else.
  std::vector<double> draw_stratified(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization,
                                      std::size_t modes) const;
  /// Z at points [-]; `xi` has terms() entries (else std::invalid_argument). Points outside the domain take the modes'
  /// analytic continuation; with circulant embedding the value at the grid's nearest node.
  std::vector<double> gaussian(std::span<const Vec2> points, std::span<const double> xi) const;

  // The parts of Z, for those who put it together from several fields: Y alone, without data and noise.

  /// Y at points [-], shape of `points`. @param xi  modes() coefficients or more, of which the first ones are used
  std::vector<double> sampled(std::span<const Vec2> points, std::span<const double> xi, Support support) const;
  /// Its variance at points [-], shape of `points`.
  std::vector<double> sampled_variance(std::span<const Vec2> points, Support support) const;
  /// Its covariances as they are drawn, [place][point]: of the values at `points` with those at the places, which are
  /// points.
  Eigen::MatrixXd sampled_covariances(std::span<const Vec2> points, std::span<const Vec2> places,
                                      Support support) const;
  /// Share of the variance of Y that averaging over cells leaves [-].
  double averaging() const;
  const Correlation& correlation() const { return correlation_; }
  const Bedding& bedding() const { return bedding_; }
  double cell() const { return cell_; }  ///< side of the cells that values are averaged over [m]; 0: values at points

 private:
  using Sampler = std::variant<KarhunenLoeve, CirculantEmbedding, PlanarEmbedding, GridExpansion>;

  static Sampler make_sampler(const FieldSpec& spec, Box domain, double dx);
  void check_given(std::size_t given) const;
  double captured() const {
    return std::visit([](const auto& s) { return s.captured_variance(); }, sampler_);
  }
  double with_nugget(double v) const { return (1 - nugget_) * v + nugget_; }
  const Sampler& sampler(Support support) const {
    return support == Support::point && at_points_ ? *at_points_ : sampler_;
  }

  Correlation correlation_;
  Bedding bedding_;
  double nugget_;
  double cell_;  ///< side of the cells that values are averaged over [m]; 0: values at points
  Sampler sampler_;
  std::optional<Sampler> at_points_;  ///< the same without averaging; unset without averaging
  std::optional<Conditioning> conditioning_;
  std::vector<Vec2> data_points_;  ///< where the data are [m]
  FieldSpec spec_;
  Box domain_;  ///< in the axes of the bedding [m]
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

/// What a trend adds to ln(tan phi): ln tan(phi + slope depth) - ln tan(phi).
/// @param tan_phi  of the surface [-], > 0
/// @param slope    increase of the friction angle with depth [rad/m]
/// @param depth    below the surface [m]; phi + slope depth must lie between 0 and pi/2
double log_trend(double tan_phi, double slope, double depth);

/// tan(phi) = exp(mu + sigma Z). [Z20] Eq. 12; mu is a value for every point, or one for all.
std::vector<double> lognormal(std::span<const double> gaussian, std::span<const double> mu, double sigma);

}  // namespace talus

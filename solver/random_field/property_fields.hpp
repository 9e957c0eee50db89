#pragma once
// The random properties of one realization: from coefficients to a value of each property at each point.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "random_field/property_laws.hpp"
#include "random_field/random_field.hpp"

namespace talus {

/// Coefficients that make one field, or one number, of one property.
struct PropertyBlock {
  std::size_t property = 0;           ///< place in FieldSpec::properties
  std::optional<std::size_t> layer;   ///< material whose own it is; unset: of all materials
  std::size_t offset = 0, count = 0;  ///< in xi
  std::uint32_t key = 0;              ///< of the draws: index of the property + 16 times the layer
};

/// The blocks of xi: properties in their order, materials in theirs; a property that is drawn once has one coefficient.
/// @param terms  of a field
std::vector<PropertyBlock> property_blocks(const FieldSpec& spec, std::span<const FieldMaterial> materials,
                                           std::size_t terms);
/// Number of coefficients of all blocks, the errors of data excepted.
std::size_t coefficients(std::span<const PropertyBlock> blocks);

/// Random properties with the covariance of FieldSpec. Immutable; safe to use from several threads at once.
///
/// Every field is divided by the standard deviation that its truncated expansion has at each point, so that a property
/// has its distribution everywhere. Averaging over cells is not undone: it leaves the share `averaging` of the
/// variance.
///
/// The independent standard normal fields W_b, one for each block, make Z_k = sum_b L_kb W_b. Data on any of the
/// properties condition all W_b together: a datum on property k is one of Z_k (Conditioning, with the weights L_kb).
/// The coefficients xi are those of the blocks, then one per datum (the error of this realization).
class PropertyFields {
 public:
  /// @param slide_box, dx  as for RandomField
  /// @param data  that PropertyLaws::unmet finds nothing against
  /// @throws ConfigError as PropertyLaws and RandomField do, and for a number of given coefficients that does not fit
  PropertyFields(const FieldSpec& spec, std::vector<FieldMaterial> materials, Box slide_box, double dx,
                 std::span<const PropertyDatum> data = {});

  const PropertyLaws& laws() const { return laws_; }
  std::size_t terms() const { return coefficients(blocks_) + data(); }
  /// The blocks of xi, the errors of data excepted.
  const std::vector<PropertyBlock>& blocks() const { return blocks_; }
  /// Coefficients of a field that are of the sampler, that of the nugget excepted.
  std::size_t modes() const { return field_ ? field_->modes() : 0; }
  /// FieldSpec::trend, which values() do not have: it depends on the surface of the soil [rad/m].
  double trend() const { return trend_; }
  /// Number of data; those on one property at one point count once.
  std::size_t data() const { return conditioning_ ? conditioning_->size() : 0; }
  /// Bound of the error of any covariance that circulant embedding makes [-].
  double embedding_error() const { return field_ ? field_->embedding_error() : 0.0; }
  /// Of the truncated expansion, before it is restored [-]; 1 where no property varies in space.
  double captured_variance() const { return field_ ? field_->captured_variance() : 1.0; }
  /// Share of the variance that averaging over cells leaves to a field, its nugget included [-].
  double averaging() const { return averaging_; }
  /// The distribution with which a property is drawn before any datum is known, averaging included.
  const Marginal& drawn(std::size_t k, std::size_t material) const { return drawn_[material * laws_.size() + k]; }

  /// Independent standard normal coefficients of one realization, or those that the specification gives. Those of a
  /// friction field through all materials are the ones of RandomField::draw.
  std::vector<double> draw(std::uint64_t seed, std::uint64_t realization) const;
  /// The same with the leading coefficients of each block from a Latin hypercube, as RandomField::draw_stratified.
  std::vector<double> draw_stratified(std::uint64_t seed, std::uint64_t realizations, std::uint64_t realization,
                                      std::size_t modes) const;

  /// Values at points, [property][point] in SI units; where a property does not apply, 0.
  /// @param materials  of the points, shape of `points`; @param xi  terms() coefficients
  std::vector<std::vector<double>> values(std::span<const Vec2> points, std::span<const std::size_t> materials,
                                          std::span<const double> xi) const;

  /// What the realizations have in common.
  struct Spread {
    std::vector<double> median;  ///< in SI units, shape of the points; 0 where the property does not apply
    std::vector<double> stdev;   ///< the same, to first order: dX/dz times the standard deviation of z
  };
  /// Median and standard deviation of the k-th property given the data. @param materials  of the points
  Spread spread(std::size_t k, std::span<const Vec2> points, std::span<const std::size_t> materials) const;

 private:
  using Rows = std::vector<std::vector<double>>;  ///< [property][point], or [field][point]

  void condition(std::span<const PropertyDatum> data);
  /// Weights of the fields that vary in space, in the order of the blocks, in the k-th property's normal number.
  std::vector<double> weights(std::size_t k, std::size_t material) const;
  /// What undoes the truncation at points: the standard deviation asked for over that which is drawn [-].
  std::vector<double> scales(std::span<const Vec2> points, Support support) const;
  /// Y_b of each such field, [field][point], without noise and data, of the variance that is asked for.
  Rows restored(std::span<const Vec2> points, std::span<const double> xi, Support support) const;
  void meet_data(std::span<const Vec2> points, std::span<const double> xi, Rows& y) const;
  Rows normal_numbers(std::span<const Vec2> points, std::span<const std::size_t> materials,
                      std::span<const double> xi) const;
  std::vector<double> normal_variance(std::size_t k, std::span<const Vec2> points,
                                      std::span<const std::size_t> materials) const;

  PropertyLaws laws_;
  std::optional<RandomField> field_;
  std::vector<PropertyBlock> blocks_;
  std::vector<PropertyBlock> fields_;  ///< those of them that vary in space
  std::optional<Conditioning> conditioning_;
  std::vector<Vec2> data_points_;  ///< [m]
  std::vector<double> given_;
  double nugget_, trend_;
  double averaging_ = 1.0;
  std::vector<Marginal> drawn_;
};

}  // namespace talus

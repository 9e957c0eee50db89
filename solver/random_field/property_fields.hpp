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
/// Number of coefficients of all blocks.
std::size_t coefficients(std::span<const PropertyBlock> blocks);

/// Random properties with the covariance of FieldSpec. Immutable; safe to use from several threads at once.
///
/// Every field is divided by the standard deviation that its truncated expansion has at each point, so that a property
/// has its distribution everywhere. Averaging over cells is not undone: it takes `averaging` of the variance.
class PropertyFields {
 public:
  /// @param slide_box, dx  as for RandomField
  /// @throws ConfigError as PropertyLaws and RandomField do, and for a number of given coefficients that does not fit
  PropertyFields(const FieldSpec& spec, std::vector<FieldMaterial> materials, Box slide_box, double dx);

  const PropertyLaws& laws() const { return laws_; }
  std::size_t terms() const { return coefficients(blocks_); }
  /// Of the truncated expansion, before it is restored [-]; 1 where no property varies in space.
  double captured_variance() const { return field_ ? field_->captured_variance() : 1.0; }
  /// Share of the variance that averaging over cells leaves to a field [-].
  double averaging() const { return averaging_; }
  /// The distribution with which a property is drawn, averaging included.
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

 private:
  std::vector<std::vector<double>> independent(std::span<const Vec2> points, std::span<const std::size_t> materials,
                                               std::span<const double> xi) const;

  PropertyLaws laws_;
  std::optional<RandomField> field_;
  std::vector<PropertyBlock> blocks_;
  std::vector<double> given_;
  double averaging_ = 1.0;
  std::vector<Marginal> drawn_;
};

}  // namespace talus

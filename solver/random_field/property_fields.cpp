#include "random_field/property_fields.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "random_field/stream.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Below this variance a field is zero but for rounding.
constexpr double no_variance = 1e-12;

std::optional<RandomField> make_field(const FieldSpec& spec, Box slide_box, double dx) {
  if (!spec.in_space()) return std::nullopt;
  FieldSpec drawn = spec;
  drawn.xi.clear();
  return RandomField(drawn, slide_box, dx);
}

}  // namespace

std::vector<PropertyBlock> property_blocks(const FieldSpec& spec, std::span<const FieldMaterial> materials,
                                           std::size_t terms) {
  std::vector<PropertyBlock> blocks;
  std::size_t offset = 0;
  for (std::size_t k = 0; k < spec.properties.size(); ++k) {
    const PropertySpec& p = spec.properties[k];
    if (!p.random()) continue;
    const auto add = [&](std::optional<std::size_t> layer) {
      const std::size_t count = p.in_space() ? terms : 1;
      const auto key = static_cast<std::uint32_t>(index_of(p.property) + 16 * layer.value_or(0));
      blocks.push_back({.property = k, .layer = layer, .offset = offset, .count = count, .key = key});
      offset += count;
    };
    if (p.layers == Layers::one_field) add(std::nullopt);
    if (p.layers == Layers::independent)
      for (std::size_t m = 0; m < materials.size(); ++m)
        if (materials[m].used && p.applies_to(materials[m].name)) add(m);
  }
  return blocks;
}

std::size_t coefficients(std::span<const PropertyBlock> blocks) {
  return blocks.empty() ? 0 : blocks.back().offset + blocks.back().count;
}

PropertyFields::PropertyFields(const FieldSpec& spec, std::vector<FieldMaterial> materials, Box slide_box, double dx)
    : laws_(spec, materials),
      field_(make_field(spec, slide_box, dx)),
      blocks_(property_blocks(spec, materials, field_ ? field_->terms() : 0)),
      given_(spec.xi) {
  if (!given_.empty() && given_.size() != terms())
    throw ConfigError("/random_field/xi", "has " + std::to_string(given_.size()) +
                                              " coefficients, the properties take " + std::to_string(terms()));
  if (field_) averaging_ = std::min(1.0, field_->variance() / field_->captured_variance());
  for (std::size_t m = 0; m < materials.size(); ++m)
    for (std::size_t k = 0; k < laws_.size(); ++k)
      drawn_.push_back(laws_.marginal(k, m).averaged(laws_.spec(k).in_space() ? averaging_ : 1.0));
}

std::vector<double> PropertyFields::draw(std::uint64_t seed, std::uint64_t realization) const {
  if (!given_.empty()) return given_;
  std::vector<double> xi;
  xi.reserve(terms());
  for (const PropertyBlock& block : blocks_)
    for (std::size_t k = 0; k < block.count; ++k)
      xi.push_back(standard_normal(seed, realization, static_cast<std::uint32_t>(k), block.key));
  return xi;
}

std::vector<double> PropertyFields::draw_stratified(std::uint64_t seed, std::uint64_t realizations,
                                                    std::uint64_t realization, std::size_t modes) const {
  std::vector<double> xi = draw(seed, realization);
  if (!given_.empty()) return xi;
  for (const PropertyBlock& block : blocks_) {
    const auto leading = stratified_normals(seed, realizations, realization, std::min(modes, block.count), block.key);
    std::copy(leading.begin(), leading.end(), xi.begin() + static_cast<std::ptrdiff_t>(block.offset));
  }
  return xi;
}

/// Independent standard normal numbers of each property at each point: variance 1 whatever the truncation.
std::vector<std::vector<double>> PropertyFields::independent(std::span<const Vec2> points,
                                                             std::span<const std::size_t> materials,
                                                             std::span<const double> xi) const {
  std::vector<std::vector<double>> w(laws_.size(), std::vector<double>(points.size(), 0.0));
  std::vector<double> variance;
  if (field_) variance = field_->variance(points);
  for (const PropertyBlock& block : blocks_) {
    const auto of_block = xi.subspan(block.offset, block.count);
    const bool varies = laws_.spec(block.property).in_space();
    std::vector<double> z;
    if (varies) z = field_->gaussian(points, of_block);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (block.layer && *block.layer != materials[i]) continue;
      const double scaled = !varies ? of_block[0] : variance[i] > no_variance ? z[i] / std::sqrt(variance[i]) : 0.0;
      w[block.property][i] = scaled;
    }
  }
  return w;
}

std::vector<std::vector<double>> PropertyFields::values(std::span<const Vec2> points,
                                                        std::span<const std::size_t> materials,
                                                        std::span<const double> xi) const {
  if (xi.size() != terms()) throw std::invalid_argument("PropertyFields::values: xi does not have terms() entries");
  const auto w = independent(points, materials, xi);
  std::vector<std::vector<double>> values(laws_.size(), std::vector<double>(points.size(), 0.0));
  for (std::size_t k = 0; k < laws_.size(); ++k)
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!laws_.applies(k, materials[i])) continue;
      const auto row = laws_.mixing(k, materials[i]);
      double z = 0.0;
      for (std::size_t q = 0; q <= k; ++q) z += row[q] * w[q][i];
      values[k][i] = drawn(k, materials[i]).value(z);
    }
  return values;
}

}  // namespace talus

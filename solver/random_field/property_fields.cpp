#include "random_field/property_fields.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "random_field/stream.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// Below this variance a field is zero but for rounding.
constexpr double no_variance = 1e-12;

/// Number of the field that keys the errors of data: after every property, through all materials.
constexpr std::uint32_t key_of_errors = 15;
static_assert(property_count <= key_of_errors);

std::optional<RandomField> make_field(const FieldSpec& spec, Box slide_box, double dx) {
  if (!spec.in_space()) return std::nullopt;
  FieldSpec drawn = spec;
  drawn.xi.clear();
  drawn.data.clear();
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
        if (materials[m].used && materials[m].takes(p)) add(m);
  }
  return blocks;
}

std::size_t coefficients(std::span<const PropertyBlock> blocks) {
  return blocks.empty() ? 0 : blocks.back().offset + blocks.back().count;
}

PropertyFields::PropertyFields(const FieldSpec& spec, std::vector<FieldMaterial> materials, Box slide_box, double dx,
                               std::span<const PropertyDatum> data)
    : laws_(spec, materials),
      field_(make_field(spec, slide_box, dx)),
      blocks_(property_blocks(spec, materials, field_ ? field_->terms() : 0)),
      given_(spec.xi),
      nugget_(spec.nugget),
      trend_(spec.trend) {
  std::ranges::copy_if(blocks_, std::back_inserter(fields_),
                       [&](const PropertyBlock& b) { return laws_.spec(b.property).in_space(); });
  if (!data.empty()) condition(data);
  if (!given_.empty() && given_.size() != terms())
    throw ConfigError("/random_field/xi", "has " + std::to_string(given_.size()) +
                                              " coefficients, the properties take " + std::to_string(terms()));
  if (field_) averaging_ = (1 - nugget_) * field_->averaging() + nugget_;
  for (std::size_t m = 0; m < materials.size(); ++m)
    for (std::size_t k = 0; k < laws_.size(); ++k)
      drawn_.push_back(laws_.marginal(k, m).averaged(laws_.spec(k).in_space() ? averaging_ : 1.0));
}

void PropertyFields::condition(std::span<const PropertyDatum> data) {
  std::vector<GaussianDatum> gaussian;
  for (const PropertyDatum& datum : data) {
    const Marginal& marginal = laws_.marginal(datum.property, datum.material);
    const double z = marginal.normal_number(datum.value);
    gaussian.push_back({datum.x, z, datum.error / marginal.slope(z), weights(datum.property, datum.material)});
  }
  gaussian = merged(gaussian);
  for (GaussianDatum& datum : gaussian) {
    data_points_.push_back(datum.x);
    datum.x = field_->bedding().turned(datum.x);
  }
  conditioning_.emplace(field_->correlation(), nugget_, std::move(gaussian));
}

std::vector<double> PropertyFields::weights(std::size_t k, std::size_t material) const {
  const auto row = laws_.mixing(k, material);
  std::vector<double> w;
  for (const PropertyBlock& block : fields_)
    w.push_back(block.layer.value_or(material) == material ? row[block.property] : 0.0);
  return w;
}

std::vector<double> PropertyFields::draw(std::uint64_t seed, std::uint64_t realization) const {
  if (!given_.empty()) return given_;
  std::vector<double> xi;
  xi.reserve(terms());
  const auto append = [&](std::size_t count, std::uint32_t key) {
    for (std::size_t k = 0; k < count; ++k)
      xi.push_back(standard_normal(seed, realization, static_cast<std::uint32_t>(k), key));
  };
  for (const PropertyBlock& block : blocks_) append(block.count, block.key);
  append(data(), key_of_errors);
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

std::vector<double> PropertyFields::scales(std::span<const Vec2> points, Support support) const {
  const double wanted = (1 - nugget_) * (support == Support::cell ? field_->averaging() : 1.0);
  std::vector<double> scales = field_->sampled_variance(points, support);
  for (double& v : scales) v = v > no_variance ? std::sqrt(wanted / v) : 0.0;
  return scales;
}

PropertyFields::Rows PropertyFields::restored(std::span<const Vec2> points, std::span<const double> xi,
                                              Support support) const {
  Rows y;
  if (!field_) return y;
  const std::vector<double> scale = scales(points, support);
  for (const PropertyBlock& block : fields_) {
    std::vector<double>& row = y.emplace_back(field_->sampled(points, xi.subspan(block.offset), support));
    for (std::size_t i = 0; i < row.size(); ++i) row[i] *= scale[i];
  }
  return y;
}

/// Makes the fields meet the data: kriging of the residuals, for all of them together.
void PropertyFields::meet_data(std::span<const Vec2> points, std::span<const double> xi, Rows& y) const {
  const Eigen::MatrixXd& weights = conditioning_->weights();
  const Rows at_data = restored(data_points_, xi, Support::point);
  std::vector<double> drawn(data(), 0.0);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    for (std::size_t f = 0; f < fields_.size(); ++f)
      drawn[i] += weights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(f)) * at_data[f][i];
  const Eigen::VectorXd a = conditioning_->coefficients(drawn, xi.last(data()));
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const Eigen::VectorXd of_field = conditioning_->of_field(a, f);
    if ((of_field.array() == 0).all()) continue;
    for (std::size_t i = 0; i < points.size(); ++i)
      y[f][i] += conditioning_->correction(field_->bedding().turned(points[i]), field_->cell(), of_field);
  }
}

PropertyFields::Rows PropertyFields::normal_numbers(std::span<const Vec2> points,
                                                    std::span<const std::size_t> materials,
                                                    std::span<const double> xi) const {
  Rows y = restored(points, xi, Support::cell);
  if (conditioning_) meet_data(points, xi, y);
  Rows w(laws_.size(), std::vector<double>(points.size(), 0.0));
  std::size_t f = 0;
  for (const PropertyBlock& block : blocks_) {
    const bool varies = laws_.spec(block.property).in_space();
    const double key = xi[block.offset + block.count - 1];  // of the noise; the value that is drawn once
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (block.layer.value_or(materials[i]) != materials[i]) continue;
      if (varies && nugget_ > 0) y[f][i] += std::sqrt(nugget_) * white_noise(key, points[i]);
      w[block.property][i] = varies ? y[f][i] / std::sqrt(averaging_) : key;
    }
    if (varies) ++f;
  }
  Rows z(laws_.size(), std::vector<double>(points.size(), 0.0));
  for (std::size_t k = 0; k < laws_.size(); ++k)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto row = laws_.mixing(k, materials[i]);
      for (std::size_t q = 0; q <= k; ++q) z[k][i] += row[q] * w[q][i];
    }
  return z;
}

std::vector<std::vector<double>> PropertyFields::values(std::span<const Vec2> points,
                                                        std::span<const std::size_t> materials,
                                                        std::span<const double> xi) const {
  if (xi.size() != terms()) throw std::invalid_argument("PropertyFields::values: xi does not have terms() entries");
  Rows values = normal_numbers(points, materials, xi);
  for (std::size_t k = 0; k < laws_.size(); ++k)
    for (std::size_t i = 0; i < points.size(); ++i)
      values[k][i] = laws_.applies(k, materials[i]) ? drawn(k, materials[i]).value(values[k][i]) : 0.0;
  return values;
}

std::vector<double> PropertyFields::normal_variance(std::size_t k, std::span<const Vec2> points,
                                                    std::span<const std::size_t> materials) const {
  std::vector<double> variance(points.size(), 1.0);
  if (!conditioning_ || !laws_.spec(k).in_space()) return variance;
  const auto as_vector = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  const std::vector<double> at_data = scales(data_points_, Support::point), at_points = scales(points, Support::cell);
  const auto of_places = as_vector(at_data).asDiagonal();
  const Eigen::MatrixXd drawn = field_->sampled_covariances(data_points_, data_points_, Support::point);
  const Eigen::MatrixXd of_data = conditioning_->common().cwiseProduct(of_places * drawn * of_places);
  const Eigen::MatrixXd with_data =
      of_places * field_->sampled_covariances(points, data_points_, Support::cell) * as_vector(at_points).asDiagonal();
  const double unconditional = (1 - nugget_) * field_->averaging();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::VectorXd common = conditioning_->common(weights(k, materials[i]));
    const Eigen::VectorXd kriging =
        common.cwiseProduct(conditioning_->covariances(field_->bedding().turned(points[i]), field_->cell()));
    const Eigen::VectorXd c = common.cwiseProduct(with_data.col(static_cast<Eigen::Index>(i)));
    variance[i] = (nugget_ + std::max(0.0, conditioning_->variance(kriging, unconditional, c, of_data))) / averaging_;
  }
  return variance;
}

PropertyFields::Spread PropertyFields::spread(std::size_t k, std::span<const Vec2> points,
                                              std::span<const std::size_t> materials) const {
  const std::vector<double> none(terms(), 0.0);
  const std::vector<double> z = normal_numbers(points, materials, none)[k];
  const std::vector<double> variance = normal_variance(k, points, materials);
  Spread out{std::vector<double>(points.size(), 0.0), std::vector<double>(points.size(), 0.0)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!laws_.applies(k, materials[i])) continue;
    const Marginal& law = drawn(k, materials[i]);
    out.median[i] = law.value(z[i]);
    out.stdev[i] = law.slope(z[i]) * std::sqrt(variance[i]);
  }
  return out;
}

}  // namespace talus

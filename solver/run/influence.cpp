#include "run/influence.hpp"

#include <algorithm>
#include <cmath>

#include "particles/geometry.hpp"
#include "run/friction_field.hpp"

namespace talus {
namespace {

/// a_k(x) / stdev(Z(x)) of the modes of a field.
class StandardModes {
 public:
  StandardModes(const RandomField& field, std::span<const Vec2> points)
      : field_(field), points_(points), none_(field.terms(), 0.0), mean_(field.gaussian(points, none_)) {
    for (const double variance : field.conditional_variance(points))
      scale_.push_back(variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0);
  }
  std::vector<double> operator()(std::uint32_t mode) const {
    std::vector<double> one = none_;
    one[mode] = 1.0;
    std::vector<double> a = field_.gaussian(points_, one);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = (a[i] - mean_[i]) * scale_[i];
    return a;
  }

 private:
  const RandomField& field_;
  std::span<const Vec2> points_;
  std::vector<double> none_, mean_, scale_;
};

/// The slopes of one block.
std::vector<std::size_t> slopes_of(std::size_t block, const RegressionSummary& regression) {
  std::vector<std::size_t> slopes;
  for (std::size_t k = 0; k < regression.numbers.size(); ++k)
    if (regression.numbers[k].block == block) slopes.push_back(k);
  return slopes;
}

Influence influence_of(std::size_t block, const std::vector<std::size_t>& slopes, const StandardModes& modes,
                       const RegressionSummary& regression, std::size_t points) {
  const ControlledMean& of = regression.mean;
  std::vector<std::vector<double>> a;
  for (const std::size_t k : slopes) a.push_back(modes(regression.numbers[k].mode));
  Influence result{.block = block, .value = std::vector<double>(points, 0.0), .half_width = {}};
  for (std::size_t i = 0; i < points; ++i) {
    double variance = 0.0;
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      result.value[i] += of.slopes[slopes[j]].value * a[j][i];
      for (std::size_t k = 0; k < slopes.size(); ++k)
        variance += of.slope_covariance[slopes[j]][slopes[k]] * a[j][i] * a[k][i];
    }
    result.half_width.push_back(of.student * std::sqrt(std::max(variance, 0.0)));
  }
  return result;
}

}  // namespace

std::vector<Influence> influence_at(const Case& problem, std::span<const Vec2> points, const Plan& plan,
                                    const RegressionSummary& regression) {
  const FieldSpec& spec = *problem.field;
  const bool short_form = spec.properties.empty();
  if (!short_form && !spec.data.empty()) return {};
  const RandomField field = short_form ? make_field(problem.model, spec)
                                       : RandomField(spec, bounding_box(problem.model.slide), problem.model.dx);
  const StandardModes modes(field, points);
  std::vector<Influence> all;
  for (std::size_t block = 0; block < plan.draws.size(); ++block) {
    const std::vector<std::size_t> slopes = slopes_of(block, regression);
    if (plan.draws[block].count > 1 && !slopes.empty())
      all.push_back(influence_of(block, slopes, modes, regression, points.size()));
  }
  return all;
}

}  // namespace talus

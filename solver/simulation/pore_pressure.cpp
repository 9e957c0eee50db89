#include "simulation/pore_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "material/pore_pressure.hpp"
#include "particles/geometry.hpp"

namespace talus {
namespace {

/// An interval of x [m].
struct Interval {
  double low, high;
};

/// Where soil lies along x: the parts of the slide, joined where they overlap or touch.
std::vector<Interval> soil_along_x(std::span<const SlidePart> slide) {
  std::vector<Interval> parts;
  for (const SlidePart& part : slide) {
    const auto [low, high] = std::ranges::minmax(part.outline, {}, &Vec2::x);
    parts.push_back({low.x, high.x});
  }
  std::ranges::sort(parts, {}, &Interval::low);
  std::vector<Interval> joined;
  for (const Interval& part : parts) {
    if (joined.empty() || part.low > joined.back().high)
      joined.push_back(part);
    else
      joined.back().high = std::max(joined.back().high, part.high);
  }
  return joined;
}

/// Slope of the chord of a line over [x - reach, x + reach], as far as it lies in `within`.
/// @param height  of the line at an x inside `within` [m]
double chord_slope(const std::function<double(double)>& height, Interval within, double x, double reach) {
  const double inset = 1e-9 * (within.high - within.low);  // at its very end an outline has no top
  const double left = std::max(x - reach, within.low + inset), right = std::min(x + reach, within.high - inset);
  return right > left ? (height(right) - height(left)) / (right - left) : 0.0;
}

double height_of_line(std::span<const Vec2> line, double x) {
  const auto right = std::ranges::upper_bound(line, x, {}, &Vec2::x);
  if (right == line.begin()) return line.front().y;
  if (right == line.end()) return line.back().y;
  return height_at(*std::prev(right), *right, x);
}

/// One slide and its water.
class GroundWater {
 public:
  explicit GroundWater(const Model& model) : model_(model), soil_(soil_along_x(model.slide)) {}

  double depth(Vec2 x) const { return std::max(top_of(model_.slide, x.x).value_or(x.y) - x.y, 0.0); }

  double ratio(const SoilPoint& point) const {
    const Material& material = model_.materials[static_cast<std::size_t>(point.material)];
    if (material.undrained || (!material.r_u && model_.water.line.empty())) return 0.0;
    const double sigma_v = mass_above(model_.slide, model_.materials, point.x) * norm(model_.g);
    const double reach = std::max(depth(point.x), 0.5 * model_.dx);
    const double u = material.r_u ? ratio_pressure(*material.r_u, sigma_v) : pressure_below_line(point.x, reach);
    return u > 0.0 ? pore_pressure_ratio(u, sigma_v, slope_of_ground(point.x.x, reach)) : 0.0;
  }

 private:
  double pressure_below_line(Vec2 x, double reach) const {
    const std::vector<Vec2>& line = model_.water.line;
    const auto height = [&](double at) { return height_of_line(line, at); };
    const double water = std::min(height(x.x), top_of(model_.slide, x.x).value_or(x.y));
    return seepage_pressure(model_.water.density * norm(model_.g), water - x.y,
                            chord_slope(height, {line.front().x, line.back().x}, x.x, reach));
  }

  double slope_of_ground(double x, double reach) const {
    const auto within = std::ranges::find_if(soil_, [&](const Interval& i) { return x >= i.low && x <= i.high; });
    if (within == soil_.end()) return 0.0;
    return chord_slope([&](double at) { return top_of(model_.slide, at).value_or(0.0); }, *within, x, reach);
  }

  const Model& model_;
  std::vector<Interval> soil_;
};

}  // namespace

std::vector<double> pore_pressure_ratios(const Model& model, std::span<const SoilPoint> points) {
  const GroundWater water(model);
  std::vector<double> ratios;
  for (const SoilPoint& point : points) ratios.push_back(water.ratio(point));
  return ratios;
}

std::vector<double> depths(const Model& model, std::span<const SoilPoint> points) {
  const GroundWater ground(model);
  std::vector<double> depths;
  for (const SoilPoint& point : points) depths.push_back(ground.depth(point.x));
  return depths;
}

PorePressureSummary summary_of(std::span<const double> ratios) {
  PorePressureSummary s;
  for (const double lambda : ratios) {
    if (lambda > 0.0) ++s.wet;
    if (lambda >= 1.0) ++s.liquefied;
    s.mean += lambda;
  }
  if (s.wet > 0) s.mean /= static_cast<double>(s.wet);
  return s;
}

bool has_pore_pressure(const Model& model) {
  return std::ranges::any_of(model.materials, [&](const Material& m) {
    return !m.undrained && (m.r_u ? *m.r_u > 0.0 : !model.water.line.empty());
  });
}

}  // namespace talus

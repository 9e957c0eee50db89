#include "simulation/reach.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "material/pore_pressure.hpp"
#include "particles/geometry.hpp"

namespace talus {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Friction angle of a material once it has softened, as the water leaves it on level ground.
double lowest_friction_angle(const Model& model, const Material& m) {
  const double phi = m.softening && m.softening->phi ? std::min(m.phi, *m.softening->phi) : m.phi;
  const double line = model.water.line.empty() ? 0.0 : model.water.density / m.rho0;
  const double lambda = m.undrained ? 0.0 : m.r_u.value_or(line);
  return lambda > 0.0 ? std::atan(total_stress_friction(std::tan(phi), lambda)) : phi;
}

double smallest_friction_angle(const Model& model) {
  double phi = infinite;
  for (const Material& m : model.materials) phi = std::min(phi, lowest_friction_angle(model, m));
  for (const Boundary& b : model.boundaries) {
    if (b.slip == WallSlip::friction) phi = std::min(phi, b.phi);
    if (b.slip == WallSlip::free_slip) phi = 0.0;
    for (const WallStretch& stretch : b.stretches) phi = std::min(phi, stretch.phi);
  }
  return phi;
}

/// The part of an open bed beyond the slide's edge at x = edge, in the order in which the slide would pass it.
std::vector<Vec2> way_out(std::vector<Vec2> bed, double edge, SlidesTo to) {
  if (to == SlidesTo::left) std::ranges::reverse(bed);
  const auto beyond = [&](Vec2 v) { return to == SlidesTo::right ? v.x > edge : v.x < edge; };
  const auto first = std::ranges::find_if(bed, beyond);
  if (first == bed.begin() || first == bed.end()) return {first, bed.end()};
  std::vector<Vec2> way{{edge, height_at(*std::prev(first), *first, edge)}};
  way.insert(way.end(), first, bed.end());
  return way;
}

/// Lowest y of a way up to where it first meets the energy line [m].
double lowest_reached(std::span<const Vec2> way, const EnergyLine& line) {
  double lowest = infinite, over_before = 0.0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const double over = line.height(way[k].x) - way[k].y;
    if (k > 0 && over < 0.0) {
      const double share = over_before / (over_before - over);
      return std::min(lowest, way[k - 1].y + share * (way[k].y - way[k - 1].y));
    }
    lowest = std::min(lowest, way[k].y);
    over_before = std::max(over, 0.0);
  }
  return lowest;
}

}  // namespace

double EnergyLine::height(double x) const { return std::min(left + slope * x, right - slope * x); }

double least_friction(const Model& model) { return std::tan(smallest_friction_angle(model)); }

EnergyLine energy_line(const Model& model) { return energy_line(model, least_friction(model)); }

EnergyLine energy_line(const Model& model, double slope) {
  EnergyLine line{slope, -infinite, -infinite};
  for (const SlidePart& part : model.slide) {
    for (const Vec2& v : part.outline) {
      line.left = std::max(line.left, v.y - line.slope * v.x);
      line.right = std::max(line.right, v.y + line.slope * v.x);
    }
  }
  return line;
}

bool stands_by_cohesion(const Model& model) {
  const bool rough = std::ranges::all_of(
      model.boundaries, [](WallSlip s) { return s == WallSlip::no_slip; }, &Boundary::slip);
  if (!rough || model.rheology.yield == Yield::regularized) return false;
  const auto strength = [](const Material& m) { return 2.0 * m.c * std::cos(m.phi) / (1.0 - std::sin(m.phi)); };
  const double weakest = strength(std::ranges::min(model.materials, {}, strength));
  const double densest = std::ranges::max(model.materials, {}, &Material::rho0).rho0;
  return weakest > densest * norm(model.g) * bounding_box(model.slide).height();
}

double fall_height(const Model& model) {
  const Box slide = bounding_box(model.slide);
  const std::vector<Vec2>& bed = model.terrain.bed;
  const bool all = model.terrain.closed || model.g.x != 0.0;
  double lowest = slide.lo.y;
  for (const Vec2& v : bed)
    if (all || (v.x >= slide.lo.x && v.x <= slide.hi.x)) lowest = std::min(lowest, v.y);
  if (all) return slide.hi.y - lowest;
  const EnergyLine line = energy_line(model);
  lowest = std::min(lowest, lowest_reached(way_out(bed, slide.lo.x, SlidesTo::left), line));
  lowest = std::min(lowest, lowest_reached(way_out(bed, slide.hi.x, SlidesTo::right), line));
  return slide.hi.y - lowest;
}

}  // namespace talus

#include "particles/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "particles/ground.hpp"
#include "particles/line_fit.hpp"

namespace talus {
namespace {

/// Heights at which the vertical through x crosses the outline, increasing. A vertex belongs to the edge on its right.
std::vector<double> crossings(std::span<const Vec2> outline, double x) {
  std::vector<double> heights;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
    if ((a.x <= x) != (b.x <= x)) heights.push_back(height_at(a, b, x));
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

}  // namespace

double signed_area(std::span<const Vec2> outline) {
  double twice = 0.0;
  for (std::size_t k = 0; k < outline.size(); ++k) twice += cross(outline[k], outline[(k + 1) % outline.size()]);
  return 0.5 * twice;
}

double area(std::span<const Vec2> outline) { return std::abs(signed_area(outline)); }

double height_at(Vec2 a, Vec2 b, double x) { return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x); }

Box bounding_box(std::span<const SlidePart> slide) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Box box{{inf, inf}, {-inf, -inf}};
  for (const SlidePart& part : slide)
    for (const Vec2& v : part.outline) box.include(v);
  return box;
}

double thickness_above(std::span<const Vec2> outline, Vec2 point) {
  const std::vector<double> y = crossings(outline, point.x);
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < y.size(); k += 2) length += std::max(0.0, y[k + 1] - std::max(y[k], point.y));
  return length;
}

std::optional<double> top_of(std::span<const SlidePart> slide, double x) {
  std::optional<double> top;
  for (const SlidePart& part : slide)
    if (const std::vector<double> y = crossings(part.outline, x); !y.empty())
      top = std::max(top.value_or(y.back()), y.back());
  return top;
}

double depth_below_surface(std::span<const SlidePart> slide, Vec2 point) {
  return std::max(0.0, top_of(slide, point.x).value_or(point.y) - point.y);
}

double greatest_depth(std::span<const SlidePart> slide) {
  double greatest = 0.0;
  for (const SlidePart& from : slide)
    for (const Vec2 v : from.outline)  // between vertices the depth is linear
      for (const SlidePart& part : slide)
        if (const std::vector<double> y = crossings(part.outline, v.x); !y.empty())
          greatest = std::max(greatest, depth_below_surface(slide, {v.x, y.front()}));
  return greatest;
}

int material_at(std::span<const SlidePart> slide, Vec2 point) {
  for (const SlidePart& part : slide) {
    const std::vector<double> y = crossings(part.outline, point.x);
    for (std::size_t k = 0; k + 1 < y.size(); k += 2)
      if (y[k] <= point.y && point.y <= y[k + 1]) return part.material;
  }
  return 0;
}

double mass_above(std::span<const SlidePart> slide, std::span<const Material> materials, Vec2 point) {
  double mass = 0.0;
  for (const SlidePart& part : slide)
    mass += materials[static_cast<std::size_t>(part.material)].rho0 * thickness_above(part.outline, point);
  return mass;
}

double mass_of(std::span<const SlidePart> slide, std::span<const Material> materials) {
  double mass = 0.0;
  for (const SlidePart& part : slide)
    mass += materials[static_cast<std::size_t>(part.material)].rho0 * area(part.outline);
  return mass;
}

double Polyline::length() const {
  double sum = 0.0;
  for (std::size_t s = 0; s < segments(); ++s) sum += norm(end(s) - start(s));
  return sum;
}

Vec2 Polyline::at(double s) const {
  for (std::size_t k = 0; k < segments(); ++k) {
    const double l = norm(end(k) - start(k));
    if (s <= l || k + 1 == segments()) return start(k) + (s / l) * (end(k) - start(k));
    s -= l;
  }
  return vertices.back();
}

Polyline offset_into_rock(const Polyline& line, double offset) {
  Polyline moved{{}, line.closed};
  const std::size_t n = line.vertices.size();
  for (std::size_t k = 0; k < n; ++k) {
    const bool first = k == 0 && !line.closed, last = k + 1 == n && !line.closed;
    const Vec2 n_in = first ? left_normal(line.end(0) - line.start(0))
                            : left_normal(line.vertices[k] - line.vertices[(k + n - 1) % n]);
    const Vec2 n_out = last ? n_in : left_normal(line.vertices[(k + 1) % n] - line.vertices[k]);
    // Mitre: the corner moves along the bisector so that both segments move by `offset`; never by more than 4 offsets.
    const double mitre = std::max(1.0 + dot(n_in, n_out), 0.125);
    moved.vertices.push_back(line.vertices[k] - (offset / mitre) * (n_in + n_out));
  }
  return moved;
}

Polyline ground_line(const Terrain& terrain) {
  Polyline line{terrain.bed, terrain.closed};
  if (!terrain.closed && !terrain.bed.empty()) {
    if (terrain.left_wall)
      line.vertices.insert(line.vertices.begin(), {terrain.bed.front().x, terrain.left_wall_top()});
    if (terrain.right_wall) line.vertices.push_back({terrain.bed.back().x, terrain.right_wall_top()});
  }
  return line;
}

std::vector<Polyline> wall_lines(std::span<const Boundary> boundaries, double dx, Placement placement) {
  std::vector<Polyline> lines;
  for (const Boundary& b : boundaries) {
    const Polyline line = fit_line(b.line, dx).line;
    lines.push_back(placement == Placement::nodes ? offset_into_rock(line, 0.5 * dx) : line);
  }
  return lines;
}

std::vector<WallPoint> fill_walls(const Polyline& wall, double dx, int layers, std::int32_t boundary) {
  const Ground ground({wall});
  std::vector<WallPoint> points;
  for (int k = 0; k < layers; ++k) {
    const double depth = (k + 0.5) * dx;
    const Polyline row = offset_into_rock(wall, depth);
    const double length = row.length();
    const auto n = static_cast<std::int64_t>(std::max(1.0, std::round(length / dx)));
    const double first = wall.closed ? 0.0 : 0.5;  // a ring starts on a corner, an open row half a spacing in
    for (std::int64_t i = 0; i < n; ++i) {
      const Vec2 x = row.at((static_cast<double>(i) + first) * length / static_cast<double>(n));
      const Ground::Nearest foot = ground.nearest(x);
      // Where a sharp ridge folds the row over itself, the particles that came too near the surface are dropped.
      if (-foot.distance < depth - 0.25 * dx) continue;
      points.push_back({x, foot.normal, -foot.distance, boundary});
    }
  }
  return points;
}

}  // namespace talus

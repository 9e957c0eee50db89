#include "particles/geometry.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace talus {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point>;

Polygon to_polygon(std::span<const Vec2> outline) {
  Polygon polygon;
  for (const Vec2& v : outline) bg::append(polygon.outer(), Point(v.x, v.y));
  bg::correct(polygon);
  return polygon;
}

/// Unit normal of a direction, on its left.
Vec2 left_normal(Vec2 along) { return (1.0 / norm(along)) * Vec2{-along.y, along.x}; }

/// Heights at which the vertical through x crosses the outline, increasing. A vertex belongs to the edge on its right.
std::vector<double> crossings(std::span<const Vec2> outline, double x) {
  std::vector<double> heights;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
    if ((a.x <= x) != (b.x <= x)) heights.push_back(a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x));
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

}  // namespace

double area(std::span<const Vec2> outline) {
  double twice = 0.0;
  for (std::size_t k = 0; k < outline.size(); ++k) twice += cross(outline[k], outline[(k + 1) % outline.size()]);
  return 0.5 * std::abs(twice);
}

Box bounding_box(std::span<const SlidePart> slide) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Box box{{inf, inf}, {-inf, -inf}};
  for (const SlidePart& part : slide)
    for (const Vec2& v : part.outline) {
      box.lo = {std::min(box.lo.x, v.x), std::min(box.lo.y, v.y)};
      box.hi = {std::max(box.hi.x, v.x), std::max(box.hi.y, v.y)};
    }
  return box;
}

double thickness_above(std::span<const Vec2> outline, Vec2 point) {
  const std::vector<double> y = crossings(outline, point.x);
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < y.size(); k += 2) length += std::max(0.0, y[k + 1] - std::max(y[k], point.y));
  return length;
}

double mass_above(std::span<const SlidePart> slide, std::span<const Material> materials, Vec2 point) {
  double mass = 0.0;
  for (const SlidePart& part : slide)
    mass += materials[static_cast<std::size_t>(part.material)].rho0 * thickness_above(part.outline, point);
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

Projection project(Vec2 point, const Polyline& line) {
  double best = std::numeric_limits<double>::infinity();
  Vec2 foot, normal;
  for (std::size_t s = 0; s < line.segments(); ++s) {
    const Vec2 a = line.start(s), ab = line.end(s) - a;
    const double t = std::clamp(dot(point - a, ab) / norm2(ab), 0.0, 1.0);
    const Vec2 q = a + t * ab;
    const double d2 = norm2(point - q);
    if (d2 < best * (1.0 - 1e-12)) {
      best = d2;
      foot = q;
      normal = left_normal(ab);
    } else if (d2 <= best * (1.0 + 1e-12)) {
      normal += left_normal(ab);  // a shared vertex: its normal is that of both segments together
    }
  }
  return {foot, std::copysign(std::sqrt(best), dot(point - foot, normal))};
}

double signed_distance(Vec2 point, std::span<const Polyline> lines) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Polyline& line : lines)
    if (const double d = project(point, line).distance; std::abs(d) < std::abs(nearest)) nearest = d;
  return nearest;
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
    if (terrain.left_wall) line.vertices.insert(line.vertices.begin(), {terrain.bed.front().x, terrain.wall_top});
    if (terrain.right_wall) line.vertices.push_back({terrain.bed.back().x, terrain.wall_top});
  }
  return line;
}

std::vector<Polyline> wall_lines(std::span<const Boundary> boundaries, double dx, Placement placement) {
  std::vector<Polyline> lines;
  for (const Boundary& b : boundaries)
    lines.push_back(placement == Placement::nodes ? offset_into_rock(b.line, 0.5 * dx) : b.line);
  return lines;
}

std::vector<SoilPoint> fill_slide(std::span<const SlidePart> slide, std::span<const Polyline> walls, double dx,
                                  Placement placement) {
  const bool nodes = placement == Placement::nodes;
  const Box box = bounding_box(slide);
  const double shift = nodes ? 0.0 : 0.5, tolerance = 1e-6 * dx;
  const auto columns = static_cast<std::int64_t>(std::floor(box.width() / dx + 1e-6)) + 1;
  const auto rows = static_cast<std::int64_t>(std::floor(box.height() / dx + 1e-6)) + 1;
  std::vector<Polygon> polygons;
  for (const SlidePart& part : slide) polygons.push_back(to_polygon(part.outline));
  std::vector<SoilPoint> points;
  for (std::int64_t row = 0; row < rows; ++row)
    for (std::int64_t column = 0; column < columns; ++column) {
      const Vec2 x{box.lo.x + (static_cast<double>(column) + shift) * dx,
                   box.lo.y + (static_cast<double>(row) + shift) * dx};
      // Lattice nodes that fall on the far edges would be lost to rounding: test a point pulled in by a hair.
      const Vec2 probe = nodes ? Vec2{std::clamp(x.x, box.lo.x + tolerance, box.hi.x - tolerance),
                                      std::clamp(x.y, box.lo.y + tolerance, box.hi.y - tolerance)}
                               : x;
      for (std::size_t k = 0; k < slide.size(); ++k) {
        if (!bg::covered_by(Point(probe.x, probe.y), polygons[k])) continue;
        if (signed_distance(x, walls) >= 0.5 * dx - tolerance) points.push_back({x, slide[k].material});
        break;
      }
    }
  return points;
}

std::vector<WallPoint> fill_walls(const Polyline& wall, double dx, int layers, std::int32_t boundary) {
  std::vector<WallPoint> points;
  for (int k = 0; k < layers; ++k) {
    const double depth = (k + 0.5) * dx;
    const Polyline row = offset_into_rock(wall, depth);
    const double length = row.length();
    const auto n = static_cast<std::int64_t>(std::max(1.0, std::round(length / dx)));
    const double first = wall.closed ? 0.0 : 0.5;  // a ring starts on a corner, an open row half a spacing in
    for (std::int64_t i = 0; i < n; ++i) {
      const Vec2 x = row.at((static_cast<double>(i) + first) * length / static_cast<double>(n));
      const Projection foot = project(x, wall);
      // Where a sharp ridge folds the row over itself, the particles that came too near the surface are dropped.
      if (-foot.distance < depth - 0.25 * dx) continue;
      points.push_back({x, (-1.0 / foot.distance) * (foot.point - x), -foot.distance, boundary});
    }
  }
  return points;
}

}  // namespace talus

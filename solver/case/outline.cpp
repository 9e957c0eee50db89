#include "case/outline.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point>;
using Polygons = bg::model::multi_polygon<Polygon>;

Polygon to_polygon(std::span<const Vec2> outline) {
  Polygon polygon;
  for (const Vec2& v : outline) bg::append(polygon.outer(), Point(v.x, v.y));
  bg::correct(polygon);
  return polygon;
}

/// Which side of the line a-b the point p lies on: -1, 0, 1.
int side(Vec2 a, Vec2 b, Vec2 p) {
  const double z = cross(b - a, p - a);
  return (z > 0.0) - (z < 0.0);
}

/// Whether p, known to be collinear with a-b, lies between them.
bool between(Vec2 a, Vec2 b, Vec2 p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const int c_side = side(a, b, c), d_side = side(a, b, d), a_side = side(c, d, a), b_side = side(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) || (a_side == 0 && between(c, d, a)) ||
         (b_side == 0 && between(c, d, b));
}

/// The region under (sign -1) or over (sign +1) a left-to-right surface, bounded by y = `far`.
Polygon half_plane(std::span<const Vec2> surface, double far) {
  std::vector<Vec2> ring(surface.begin(), surface.end());
  ring.push_back({surface.back().x, far});
  ring.push_back({surface.front().x, far});
  return to_polygon(ring);
}

/// Vertices of a ring, counter-clockwise from the leftmost (then lowest) one.
std::vector<Vec2> normal_form(const Polygon& polygon) {
  std::vector<Vec2> ring;
  for (const Point& p : polygon.outer()) ring.push_back({p.x(), p.y()});
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (signed_area(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  const auto first =
      std::min_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::rotate(ring.begin(), first, ring.end());
  return ring;
}

}  // namespace

std::optional<EdgePair> self_intersection(std::span<const Vec2> vertices, bool closed) {
  const std::size_t n = vertices.size(), edges = closed ? n : n - 1;
  const auto start = [&](std::size_t e) { return vertices[e]; };
  const auto end = [&](std::size_t e) { return vertices[(e + 1) % n]; };
  // Neighbours share a vertex; they are at fault only when one folds back over the other.
  for (std::size_t e = 0; e < edges; ++e) {
    if (start(e) == end(e)) return EdgePair{e, e};
    const std::size_t next = (e + 1) % n;
    if (next >= edges) continue;
    const Vec2 here = end(e) - start(e), there = end(next) - start(next);
    if (cross(here, there) == 0.0 && dot(here, there) < 0.0) return EdgePair{e, next};
  }
  // All other pairs, swept from left to right.
  const auto left = [&](std::size_t e) { return std::min(start(e).x, end(e).x); };
  std::vector<std::size_t> order(edges);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });
  for (std::size_t i = 0; i < edges; ++i)
    for (std::size_t j = i + 1; j < edges && left(order[j]) <= std::max(start(order[i]).x, end(order[i]).x); ++j) {
      const auto [a, b] = std::minmax(order[i], order[j]);
      const bool neighbours = b == a + 1 || (closed && a == 0 && b + 1 == edges);
      if (!neighbours && segments_meet(start(a), end(a), start(b), end(b))) return EdgePair{a, b};
    }
  return {};
}

double signed_area(std::span<const Vec2> outline) {
  double twice = 0.0;
  for (std::size_t k = 0; k < outline.size(); ++k) twice += cross(outline[k], outline[(k + 1) % outline.size()]);
  return 0.5 * twice;
}

double shared_area(std::span<const Vec2> a, std::span<const Vec2> b) {
  Polygons shared;
  bg::intersection(to_polygon(a), to_polygon(b), shared);
  return bg::area(shared);
}

std::vector<std::vector<Vec2>> between_surfaces(std::span<const Vec2> ground, std::span<const Vec2> slip) {
  Box box{ground[0], ground[0]};
  for (const auto& surface : {ground, slip})
    for (const Vec2& v : surface) box.include(v);
  Polygons pieces;
  bg::intersection(half_plane(ground, box.lo.y - 1.0), half_plane(slip, box.hi.y + 1.0), pieces);
  std::vector<std::vector<Vec2>> outlines;
  for (const Polygon& piece : pieces) outlines.push_back(normal_form(piece));
  std::sort(outlines.begin(), outlines.end(), [](const auto& a, const auto& b) { return a[0].x < b[0].x; });
  return outlines;
}

double bed_height(std::span<const Vec2> bed, double x) {
  x = std::clamp(x, bed.front().x, bed.back().x);
  const auto right =
      std::upper_bound(bed.begin() + 1, bed.end() - 1, x, [](double value, Vec2 v) { return value < v.x; });
  const Vec2 a = *(right - 1), b = *right;
  return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
}

Penetration depth_below_bed(std::span<const Vec2> outline, std::span<const Vec2> bed) {
  Penetration worst;
  const auto compare = [&](Vec2 p) {
    if (p.x < bed.front().x || p.x > bed.back().x) return;
    const double depth = bed_height(bed, p.x) - p.y;
    if (depth > worst.depth) worst = {p, depth};
  };
  // Along an edge the depth is piecewise linear: its maximum lies at the edge's ends or above a vertex of the bed.
  for (std::size_t k = 0; k < outline.size(); ++k) {
    Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
    compare(a);
    if (a.x > b.x) std::swap(a, b);
    auto v = std::upper_bound(bed.begin(), bed.end(), a.x, [](double x, Vec2 w) { return x < w.x; });
    for (; v != bed.end() && v->x < b.x; ++v) compare({v->x, a.y + (b.y - a.y) * (v->x - a.x) / (b.x - a.x)});
  }
  return worst;
}

Penetration reach_outside_ring(std::span<const Vec2> outline, std::span<const Vec2> ring) {
  const Polygon inside = to_polygon(ring);
  bg::model::linestring<Point> edge(inside.outer().begin(), inside.outer().end());
  Polygons outside;
  bg::difference(to_polygon(outline), inside, outside);
  Penetration worst;
  for (const Polygon& piece : outside) {
    // Rock that stands up into the outline has all its vertices on the ring: its thickness, 2 area / perimeter, counts.
    const double thickness = 2.0 * bg::area(piece) / bg::perimeter(piece);
    for (const Point& p : piece.outer())
      if (const double depth = std::max(thickness, bg::distance(p, edge)); depth > worst.depth)
        worst = {{p.x(), p.y()}, depth};
  }
  return worst;
}

}  // namespace talus

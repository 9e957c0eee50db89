#include "case/outline.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "case/overlay.hpp"
#include "particles/geometry.hpp"
#include "particles/ground.hpp"
#include "particles/polygon.hpp"

namespace talus {
namespace {

namespace bg = boost::geometry;

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

/// The region between a left-to-right surface and the level y = `far` below or above it.
Polygon half_plane(std::span<const Vec2> surface, double far) {
  std::vector<Vec2> ring(surface.begin(), surface.end());
  ring.push_back({surface.back().x, far});
  ring.push_back({surface.front().x, far});
  return to_polygon(ring);
}

/// The vertices of a polygon from the leftmost (then lowest) one.
std::vector<Vec2> normal_form(const Polygon& polygon) {
  std::vector<Vec2> ring(polygon.outer());
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

double height_beneath(std::span<const Vec2> bed, Vec2 point) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  double height = none;
  for (std::size_t k = 0; k + 1 < bed.size(); ++k) {
    const Vec2 a = bed[k], b = bed[k + 1];
    if (std::min(a.x, b.x) > point.x || std::max(a.x, b.x) < point.x) continue;
    const double y =
        a.x == b.x ? std::clamp(point.y, std::min(a.y, b.y), std::max(a.y, b.y)) : height_at(a, b, point.x);
    if (y <= point.y) height = std::max(height, y);
  }
  return height == none ? point.y : height;
}

std::vector<Vec2> room_above(std::span<const Vec2> bed, double top) {
  for (const Vec2& v : bed) top = std::max(top, v.y);
  std::vector<Vec2> ring(bed.begin(), bed.end());
  ring.push_back({bed.back().x, top + 1.0});
  ring.push_back({bed.front().x, top + 1.0});
  return ring;
}

Penetration reach_outside_ring(std::span<const Vec2> outline, std::span<const Vec2> ring) {
  const Polygon body = to_polygon(outline), inside = to_polygon(ring);
  const Ground body_edge({Polyline{body.outer(), true}}), ring_edge({Polyline{inside.outer(), true}});
  Penetration worst;
  const auto compare = [&](Vec2 at, double depth) {
    if (depth > worst.depth) worst = {at, depth};
  };
  for (const Vec2& p : body.outer()) compare(p, -ring_edge.nearest(p).distance);
  for (const Vec2& p : inside.outer()) compare(p, body_edge.nearest(p).distance);
  // A wall that stands right across the outline has no vertex in it: its thickness, 2 area / perimeter, counts.
  for (const auto& piece : pieces_outside(body.outer(), inside.outer()).value_or(Pieces{})) {
    const double perimeter = Polyline{piece, true}.length();
    compare(piece.front(), 2.0 * area(piece) / perimeter);
  }
  return worst;
}

}  // namespace talus

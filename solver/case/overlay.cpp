#include "case/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "particles/geometry.hpp"
#include "particles/polygon.hpp"

namespace talus {
namespace {

namespace bg = boost::geometry;

/// An edge that is not vertical.
struct Edge {
  Vec2 left, right;
};

std::vector<Edge> edges_of(std::span<const Vec2> ring) {
  std::vector<Edge> edges;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
    if (a.x != b.x) edges.push_back(a.x < b.x ? Edge{a, b} : Edge{b, a});
  }
  std::ranges::sort(edges, {}, [](const Edge& e) { return e.left.x; });
  return edges;
}

/// Heights of an edge on both sides of a strip.
struct Crossing {
  double y0, y1;
  double at(double t) const { return y0 + t * (y1 - y0); }
};

/// The edges of one ring that cross a strip, moved from strip to strip to the right.
class StripEdges {
 public:
  explicit StripEdges(std::vector<Edge> edges) : edges_(std::move(edges)) {}

  /// From the lowest to the highest; the ring's inside lies between the first and the second, the third and the fourth.
  std::vector<Crossing> crossings(double x0, double x1) {
    while (next_ < edges_.size() && edges_[next_].left.x <= x0) active_.push_back(edges_[next_++]);
    std::erase_if(active_, [&](const Edge& e) { return e.right.x <= x0; });
    std::vector<Crossing> all;
    for (const Edge& e : active_) all.push_back({height_at(e.left, e.right, x0), height_at(e.left, e.right, x1)});
    std::ranges::sort(all, {}, [](const Crossing& c) { return c.y0 + c.y1; });
    return all;
  }

 private:
  std::vector<Edge> edges_;  ///< by their left ends
  std::size_t next_ = 0;
  std::vector<Edge> active_;
};

/// The x of all vertices, each once.
std::vector<double> sides_of_strips(std::initializer_list<std::span<const Vec2>> rings) {
  std::vector<double> x;
  for (const auto& ring : rings)
    for (const Vec2& v : ring) x.push_back(v.x);
  std::ranges::sort(x);
  x.erase(std::unique(x.begin(), x.end()), x.end());
  return x;
}

/// Mean over a strip of the height that [a_lo, a_hi] and [b_lo, b_hi] have in common.
double common_height(Crossing a_lo, Crossing a_hi, Crossing b_lo, Crossing b_hi) {
  const auto height = [&](double t) {
    return std::max(0.0, std::min(a_hi.at(t), b_hi.at(t)) - std::max(a_lo.at(t), b_lo.at(t)));
  };
  std::array<double, 6> t{0.0, 0.0, 0.0, 0.0, 0.0, 1.0};  // between them the height is linear
  const auto crossing = [](Crossing p, Crossing q) {
    const double d0 = p.y0 - q.y0, d1 = p.y1 - q.y1;
    return d0 * d1 < 0.0 ? d0 / (d0 - d1) : 0.0;
  };
  t[1] = crossing(a_hi, b_hi);
  t[2] = crossing(a_lo, b_lo);
  t[3] = crossing(a_hi, b_lo);
  t[4] = crossing(a_lo, b_hi);
  std::ranges::sort(t);
  double mean = 0.0;
  for (std::size_t k = 0; k + 1 < t.size(); ++k) mean += 0.5 * (t[k + 1] - t[k]) * (height(t[k]) + height(t[k + 1]));
  return mean;
}

double mean_height(Crossing lo, Crossing hi) { return 0.5 * (hi.y0 - lo.y0 + hi.y1 - lo.y1); }

double total_area(const Polygons& pieces) {
  double sum = 0.0;
  for (const Polygon& piece : pieces) sum += bg::area(piece);
  return sum;
}

/// One try of the overlay.
Polygons overlay(const Polygon& body, const Polygon& ring, bool inside) {
  Polygons pieces;
  if (inside)
    bg::intersection(body, ring, pieces);
  else
    bg::difference(body, ring, pieces);
  return pieces;
}

std::optional<Pieces> checked_overlay(std::span<const Vec2> outline, std::span<const Vec2> ring, bool inside) {
  const AreaSplit split = split_area(outline, ring);
  const double expected = inside ? split.inside : split.outside, whole = split.inside + split.outside;
  if (expected <= 1e-9 * whole) return Pieces{};
  const Polygon body = to_polygon(outline), bound = to_polygon(ring);
  Box box{body.outer().front(), body.outer().front()};
  for (const Vec2& v : body.outer()) box.include(v);
  const double extent = std::max(box.width(), box.height());
  // Where edges lie on one another, the ring moved a little outwards or inwards is overlaid without trouble.
  for (const double offset : {0.0, 1e-7, -1e-7, 1e-6, -1e-6, 1e-5, -1e-5}) {
    const Polyline moved = offset_into_rock({bound.outer(), true}, offset * extent);
    const Polygons found = overlay(body, offset == 0.0 ? bound : to_polygon(moved.vertices), inside);
    if (std::abs(total_area(found) - expected) > 1e-4 * whole) continue;
    Pieces pieces;
    for (const Polygon& piece : found) {
      if (!piece.inners().empty()) return {};
      if (bg::area(piece) > 1e-9 * whole) pieces.push_back(piece.outer());
    }
    return pieces;
  }
  return {};
}

}  // namespace

AreaSplit split_area(std::span<const Vec2> outline, std::span<const Vec2> ring) {
  const auto [lo, hi] = std::ranges::minmax(outline, {}, &Vec2::x);
  StripEdges of_outline(edges_of(outline)), of_ring(edges_of(ring));
  const std::vector<double> x = sides_of_strips({outline, ring});
  AreaSplit split;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    if (x[k] < lo.x || x[k] >= hi.x) continue;
    const std::vector<Crossing> a = of_outline.crossings(x[k], x[k + 1]), b = of_ring.crossings(x[k], x[k + 1]);
    double all = 0.0, shared = 0.0;
    for (std::size_t i = 0; i + 1 < a.size(); i += 2) {
      all += mean_height(a[i], a[i + 1]);
      for (std::size_t j = 0; j + 1 < b.size(); j += 2) shared += common_height(a[i], a[i + 1], b[j], b[j + 1]);
    }
    split.inside += (x[k + 1] - x[k]) * shared;
    split.outside += (x[k + 1] - x[k]) * std::max(0.0, all - shared);
  }
  return split;
}

double shared_area(std::span<const Vec2> a, std::span<const Vec2> b) { return split_area(a, b).inside; }

std::optional<Pieces> pieces_inside(std::span<const Vec2> outline, std::span<const Vec2> ring) {
  return checked_overlay(outline, ring, true);
}

std::optional<Pieces> pieces_outside(std::span<const Vec2> outline, std::span<const Vec2> ring) {
  return checked_overlay(outline, ring, false);
}

std::vector<ThicknessStrip> thickness_strips(std::span<const SlidePart> slide) {
  std::vector<Vec2> vertices;
  std::vector<StripEdges> parts;
  for (const SlidePart& part : slide) {
    vertices.insert(vertices.end(), part.outline.begin(), part.outline.end());
    parts.emplace_back(edges_of(part.outline));
  }
  const std::vector<double> x = sides_of_strips({vertices});
  std::vector<ThicknessStrip> strips;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    ThicknessStrip strip{x[k], x[k + 1], 0.0, 0.0};
    for (StripEdges& part : parts) {
      const std::vector<Crossing> c = part.crossings(x[k], x[k + 1]);
      for (std::size_t i = 0; i + 1 < c.size(); i += 2) {
        strip.at_x0 += c[i + 1].y0 - c[i].y0;
        strip.at_x1 += c[i + 1].y1 - c[i].y1;
      }
    }
    strips.push_back(strip);
  }
  return strips;
}

}  // namespace talus

#include "particles/ground.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace talus {
namespace {

namespace bg = boost::geometry;

constexpr double finest_detail = 0.1;        ///< of the spacing: what a line keeps where its vertices are dense [-]
constexpr double noise_deviations = 4.0;     ///< one of 16,000 vertices lies farther out
constexpr std::size_t enough_vertices = 16;  ///< to tell the noise from

Vec2 left_normal(Vec2 along) { return (1.0 / norm(along)) * Vec2{-along.y, along.x}; }

/// Indices of the vertices that Douglas and Peucker's method keeps, the first and the last among them.
std::vector<std::size_t> kept_vertices(std::span<const Vec2> path, double tolerance) {
  std::vector<std::size_t> kept = {0, path.size() - 1};
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, path.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vec2 a = path[first], ab = path[last] - a;
    const double length2 = norm2(ab);
    double farthest2 = tolerance * tolerance;
    std::size_t vertex = 0;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double t = length2 > 0.0 ? std::clamp(dot(path[k] - a, ab) / length2, 0.0, 1.0) : 0.0;
      if (const double d2 = norm2(path[k] - a - t * ab); d2 > farthest2) {
        farthest2 = d2;
        vertex = k;
      }
    }
    if (vertex == 0) continue;
    kept.push_back(vertex);
    open.insert(open.end(), {{first, vertex}, {vertex, last}});
  }
  std::ranges::sort(kept);
  return kept;
}

/// Calls f(vertex, segment) for every vertex of `path` strictly between the ends of a segment of `kept`.
template <class F>
void for_each_between(const std::vector<std::size_t>& kept, F&& f) {
  for (std::size_t s = 0; s + 1 < kept.size(); ++s)
    for (std::size_t k = kept[s] + 1; k < kept[s + 1]; ++k) f(k, s);
}

/// Standard deviation of the noise across the line [m], from how far vertices lie from the middle of their neighbours
/// (its variance is 3/2 of the noise's); the median leaves corners out.
double noise_of(std::span<const Vec2> path, double dx) {
  const std::vector<std::size_t> coarse = kept_vertices(path, dx);
  std::vector<double> deviations;
  for_each_between(coarse, [&](std::size_t k, std::size_t s) {
    if (norm(path[k] - path[k - 1]) >= dx || norm(path[k + 1] - path[k]) >= dx) return;
    const Vec2 normal = left_normal(path[coarse[s + 1]] - path[coarse[s]]);
    deviations.push_back(std::abs(dot(path[k] - 0.5 * (path[k - 1] + path[k + 1]), normal)));
  });
  if (deviations.size() < enough_vertices) return 0.0;
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::ranges::nth_element(deviations, middle);
  constexpr double median_of_normal = 0.6745;
  return *middle / (median_of_normal * std::sqrt(1.5));
}

/// How far each kept vertex moves along its normal, [m], by least squares over all vertices: a tridiagonal system.
std::vector<double> least_squares_shift(std::span<const Vec2> path, const std::vector<std::size_t>& kept,
                                        std::span<const Vec2> normals) {
  const std::size_t n = kept.size();
  std::vector<double> diagonal(n, 1.0), beside(n, 0.0), shift(n, 0.0);  // the vertex itself counts as well
  for_each_between(kept, [&](std::size_t k, std::size_t s) {
    const Vec2 a = path[kept[s]], ab = path[kept[s + 1]] - a, normal = left_normal(ab);
    const double t = std::clamp(dot(path[k] - a, ab) / norm2(ab), 0.0, 1.0), e = dot(path[k] - a - t * ab, normal);
    const double w0 = (1.0 - t) * dot(normals[s], normal), w1 = t * dot(normals[s + 1], normal);
    diagonal[s] += w0 * w0;
    diagonal[s + 1] += w1 * w1;
    beside[s] += w0 * w1;
    shift[s] += w0 * e;
    shift[s + 1] += w1 * e;
  });
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = beside[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * beside[i - 1];
    shift[i] -= factor * shift[i - 1];
  }
  shift[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) shift[i] = (shift[i] - beside[i] * shift[i + 1]) / diagonal[i];
  return shift;
}

}  // namespace

FittedLine fit_line(const Polyline& line, double dx) {
  FittedLine fitted{line};
  bool fine = false;
  for (std::size_t s = 0; s < line.segments(); ++s) fine = fine || norm(line.end(s) - line.start(s)) < dx;
  if (!fine) return fitted;

  std::vector<Vec2> path = line.vertices;
  if (line.closed) path.push_back(path.front());
  fitted.noise = noise_of(path, dx);
  fitted.tolerance = std::min(std::max(finest_detail * dx, noise_deviations * fitted.noise), dx);
  const std::vector<std::size_t> kept = kept_vertices(path, fitted.tolerance);
  if (kept.size() == path.size()) return fitted;

  // Vertices move along the bisector of their segments; the ends of an open line keep their x.
  std::vector<Vec2> normals;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const bool end = i == 0 || i + 1 == kept.size();
    const Vec2 n_in = end ? Vec2{} : left_normal(path[kept[i]] - path[kept[i - 1]]);
    const Vec2 n_out = end ? Vec2{} : left_normal(path[kept[i + 1]] - path[kept[i]]);
    const Vec2 sum = n_in + n_out;
    normals.push_back(end ? Vec2{0.0, line.closed ? 0.0 : 1.0} : norm(sum) > 0.1 ? (1.0 / norm(sum)) * sum : n_in);
  }
  const std::vector<double> shift = least_squares_shift(path, kept, normals);
  fitted.line.vertices.clear();
  for (std::size_t i = 0; i < kept.size() - (line.closed ? 1 : 0); ++i)
    fitted.line.vertices.push_back(path[kept[i]] +
                                   std::clamp(shift[i], -fitted.tolerance, fitted.tolerance) * normals[i]);
  return fitted;
}

struct Ground::Segments {
  using Point = bg::model::d2::point_xy<double>;
  struct Piece {
    std::uint32_t line, segment;
  };
  using Entry = std::pair<bg::model::segment<Point>, Piece>;

  std::vector<Polyline> lines;
  bg::index::rtree<Entry, bg::index::rstar<16>> tree;

  explicit Segments(std::vector<Polyline> all) : lines(std::move(all)) {
    std::vector<Entry> entries;
    for (std::uint32_t l = 0; l < lines.size(); ++l)
      for (std::uint32_t s = 0; s < lines[l].segments(); ++s) {
        const Vec2 a = lines[l].start(s), b = lines[l].end(s);
        entries.push_back({{Point(a.x, a.y), Point(b.x, b.y)}, {l, s}});
      }
    tree = decltype(tree)(entries);
  }
};

Ground::Ground(std::vector<Polyline> lines) : segments_(std::make_unique<Segments>(std::move(lines))) {}
Ground::~Ground() = default;

Ground::Nearest Ground::nearest(Vec2 point) const {
  constexpr unsigned candidates = 4;  // two segments meet in a vertex, where lines touch even four
  Nearest found;
  double best = std::numeric_limits<double>::infinity();
  Vec2 normal;
  const auto query = bg::index::nearest(Segments::Point(point.x, point.y), candidates);
  for (auto entry = segments_->tree.qbegin(query); entry != segments_->tree.qend(); ++entry) {
    const auto [l, s] = entry->second;
    const Polyline& line = segments_->lines[l];
    const Vec2 a = line.start(s), ab = line.end(s) - a;
    const double along = dot(point - a, ab) / norm2(ab), t = std::clamp(along, 0.0, 1.0);
    const Vec2 q = a + t * ab;
    const double d2 = norm2(point - q);
    if (d2 < best * (1.0 - 1e-12)) {
      best = d2;
      normal = left_normal(ab);
      const bool first = s == 0, last = s + 1 == line.segments();
      found = {q, 0.0, {}, l, !line.closed && ((first && along < 0.0) || (last && along > 1.0))};
    } else if (d2 <= best * (1.0 + 1e-12)) {
      normal += left_normal(ab);  // a shared vertex: its normal is that of both segments together
    }
  }
  const Vec2 to_point = point - found.point;
  found.distance = std::copysign(std::sqrt(best), dot(to_point, normal));
  const double least = 1e-9 * norm(found.point);  // nearer than that the direction is rounding
  found.normal = std::abs(found.distance) > least ? (1.0 / found.distance) * to_point : (1.0 / norm(normal)) * normal;
  return found;
}

}  // namespace talus

#include "particles/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "particles/ground.hpp"
#include "particles/polygon.hpp"

namespace talus {
namespace {

namespace bg = boost::geometry;

constexpr double finest_detail = 0.1;        ///< of the spacing: what a line keeps where its vertices are dense [-]
constexpr double noise_deviations = 4.0;     ///< one of 16,000 vertices lies farther out
constexpr double shallowest_notch = 0.25;    ///< of the spacing: what a particle cannot enter deeper is left open [-]
constexpr std::size_t enough_vertices = 16;  ///< to tell the noise from

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

using Room = bg::model::polygon<Vec2, false>;  // counter-clockwise, first vertex repeated
using Region = bg::model::multi_polygon<Room>;

Region grown(const Region& region, double distance) {
  constexpr std::size_t points_per_circle = 48;
  Region result;
  bg::buffer(region, result, bg::strategy::buffer::distance_symmetric<double>(distance),
             bg::strategy::buffer::side_straight(), bg::strategy::buffer::join_round(points_per_circle),
             bg::strategy::buffer::end_flat(), bg::strategy::buffer::point_circle(points_per_circle));
  return result;
}

/// The largest part of what a disc of radius r that stays within the region covers.
Room opened(const Room& region, double r) {
  const Region open = grown(grown({region}, -r), r);
  const auto largest = std::ranges::max_element(open, {}, [](const Room& part) { return bg::area(part); });
  return largest == open.end() ? region : *largest;
}

/// The room above an open line, or inside a ring: the line's vertices first.
Room room_of(const Polyline& line, double margin) {
  Room room;
  double top = -std::numeric_limits<double>::infinity();
  for (const Vec2& v : line.vertices) {
    room.outer().push_back(v);
    top = std::max(top, v.y);
  }
  if (!line.closed) {
    const Vec2 first = line.vertices.front(), last = line.vertices.back();
    const double left = first.x - margin, right = last.x + margin, above = top + margin;
    room.outer().insert(room.outer().end(), {{right, last.y}, {right, above}, {left, above}, {left, first.y}});
  }
  bg::correct(room);
  return room;
}

/// Vertices of a ring from the one nearest to `first` to the one nearest to `last`.
std::vector<Vec2> stretch_of(const std::vector<Vec2>& ring, Vec2 first, Vec2 last) {
  const std::size_t n = ring.size() - 1;  // the first is repeated at the end
  const auto vertex = [&](std::size_t k) { return ring[k % n]; };
  const auto nearest_to = [&](Vec2 p) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < n; ++k)
      if (norm2(vertex(k) - p) < norm2(vertex(best) - p)) best = k;
    return best;
  };
  const std::size_t begin = nearest_to(first), end = nearest_to(last);
  std::vector<Vec2> path = {first};
  for (std::size_t k = begin + 1; k % n != end; ++k) path.push_back(vertex(k));
  path.push_back(last);
  return path;
}

/// Whether a disc of radius r = dx/2 on the soil's side comes nearer to vertex k than shallowest_notch dx.
bool disc_reaches(const Polyline& line, const Ground& ground, std::size_t k, double r) {
  const Vec2 v = line.vertices[k];
  const auto free = [&](Vec2 direction) {
    return ground.nearest(v + (1.0 + 2.0 * shallowest_notch) * r * direction).distance >= 0.9999 * r;
  };
  const std::size_t n = line.vertices.size();
  if (!line.closed && (k == 0 || k + 1 == n)) return true;
  const Vec2 bisector = left_normal(v - line.vertices[(k + n - 1) % n]) + left_normal(line.vertices[(k + 1) % n] - v);
  if (norm(bisector) > 0.0 && free((1.0 / norm(bisector)) * bisector)) return true;
  constexpr int directions = 32;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / directions;
    if (free({std::cos(angle), std::sin(angle)})) return true;
  }
  return false;
}

/// Fills notches that are too narrow for a particle: the line that a disc of diameter dx can touch. A line whose
/// vertices such a disc reaches to 0.25 dx stays as it is.
Polyline without_narrow_notches(const Polyline& line, double dx) {
  const double r = 0.5 * dx;
  const Ground ground({line});
  bool narrow = false;
  for (std::size_t k = 0; k < line.vertices.size() && !narrow; ++k) narrow = !disc_reaches(line, ground, k, r);
  const Room room = room_of(line, 8.0 * dx);
  if (!narrow || !bg::is_valid(room)) return line;
  const std::vector<Vec2> ring = opened(room, r).outer();
  const Vec2 start = line.closed ? ring.front() : line.vertices.front();
  const std::vector<Vec2> path = stretch_of(ring, start, line.closed ? start : line.vertices.back());
  Polyline filled{{}, line.closed};
  for (const std::size_t k : kept_vertices(path, 0.02 * dx)) filled.vertices.push_back(path[k]);
  if (line.closed) filled.vertices.pop_back();
  return filled;
}

FittedLine without_noise(const Polyline& line, double dx) {
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

/// Runs of vertices that lie behind the line by more than a particle could have reached.
void count_notches(const Polyline& open, double dx, FittedLine& filled) {
  const Ground ground({filled.line});
  bool in_notch = false;
  for (const Vec2& v : open.vertices) {
    const double depth = -ground.nearest(v).distance;
    const bool deep = depth > shallowest_notch * dx;
    filled.notches += deep && !in_notch ? 1 : 0;
    filled.deepest_notch = std::max(filled.deepest_notch, deep ? depth : 0.0);
    in_notch = deep;
  }
}

}  // namespace

FittedLine fit_line(const Polyline& line, double dx) {
  FittedLine fitted = without_noise(line, dx);
  if (fitted.line.vertices.size() != line.vertices.size()) {
    const Ground smooth({fitted.line});
    for (const Vec2& v : line.vertices) fitted.moved = std::max(fitted.moved, std::abs(smooth.nearest(v).distance));
  }
  const Polyline open = fitted.line;
  fitted.line = without_narrow_notches(open, dx);
  if (!(fitted.line == open)) count_notches(open, dx, fitted);
  return fitted;
}

}  // namespace talus

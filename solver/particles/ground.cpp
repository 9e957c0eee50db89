#include "particles/ground.hpp"

#include <boost/geometry/geometries/segment.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "particles/polygon.hpp"

namespace talus {

namespace bg = boost::geometry;

struct Ground::Segments {
  struct Piece {
    std::uint32_t line, segment;
  };
  using Entry = std::pair<bg::model::segment<Vec2>, Piece>;

  std::vector<Polyline> lines;
  bg::index::rtree<Entry, bg::index::rstar<16>> tree;

  explicit Segments(std::vector<Polyline> all) : lines(std::move(all)) {
    std::vector<Entry> entries;
    for (std::uint32_t l = 0; l < lines.size(); ++l)
      for (std::uint32_t s = 0; s < lines[l].segments(); ++s) {
        const Vec2 a = lines[l].start(s), b = lines[l].end(s);
        entries.push_back({{a, b}, {l, s}});
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
  const auto query = bg::index::nearest(point, candidates);
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

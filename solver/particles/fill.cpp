#include "particles/fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "particles/geometry.hpp"
#include "particles/ground.hpp"
#include "particles/polygon.hpp"

namespace talus {
namespace {

using Outline = std::vector<Vec2>;

/// What is not told from a whole cell, from nothing, or from an equal length; so that rounding decides nothing [dx2,
/// dx].
constexpr double negligible = 1e-6;

/// The part of a polygon on one side of a line along an axis, by the method of Sutherland and Hodgman 1974. Where it
/// falls apart, its pieces stay joined by edges along the line that cancel in sums over the edges.
/// @param sign  1.0: keep what is beyond `at`; -1.0: keep what is before it
Outline clip(const Outline& polygon, double Vec2::*axis, double at, double sign) {
  Outline kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    const double from = sign * (a.*axis - at), to = sign * (b.*axis - at);
    if (from >= 0.0) kept.push_back(a);
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
      Vec2 crossing = a + (from / (from - to)) * (b - a);
      crossing.*axis = at;
      kept.push_back(crossing);
    }
  }
  return kept;
}

/// Area and first moment of a polygon walked counter-clockwise.
struct Moments {
  double area = 0.0;
  Vec2 first;
};

Moments moments(const Outline& polygon) {
  Moments sum{signed_area(polygon), {}};
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    sum.first += (cross(a, b) / 6.0) * (a + b);
  }
  return sum;
}

/// Coordinates along the rows and columns of a lattice, in dx from the corner of a cell.
class LatticeFrame {
 public:
  /// @param corner  about which the lattice is turned and from which it is shifted [m]
  LatticeFrame(Vec2 corner, double dx, const Lattice& lattice)
      : corner_(corner), dx_(dx), shift_(lattice.shift), cos_(std::cos(lattice.angle)), sin_(std::sin(lattice.angle)) {}

  Vec2 from_plane(Vec2 x) const {
    const Vec2 d = (1.0 / dx_) * (x - corner_);
    return Vec2{cos_ * d.x + sin_ * d.y, cos_ * d.y - sin_ * d.x} - shift_;
  }
  Vec2 to_plane(Vec2 u) const {
    const Vec2 d = u + shift_;
    return corner_ + dx_ * Vec2{cos_ * d.x - sin_ * d.y, cos_ * d.y + sin_ * d.x};
  }

 private:
  Vec2 corner_;
  double dx_;
  Vec2 shift_;
  double cos_, sin_;
};

/// A lattice cell.
struct CellIndex {
  std::int64_t row = 0, column = 0;
  auto operator<=>(const CellIndex&) const = default;
};

/// The piece of a cell that lies in an outline. Lengths are in dx, coordinates from the cell's lower left corner.
struct Piece {
  CellIndex cell;
  double area = 1.0;
  Vec2 centroid{0.5, 0.5};
  std::array<double, 4> side{1.0, 1.0, 1.0, 1.0};  ///< length shared with the cells right, above, left and below
};

constexpr std::array<CellIndex, 4> neighbour_cells{{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

/// A piece from its polygon in lattice coordinates.
Piece cut_piece(const Outline& polygon, CellIndex cell) {
  const Vec2 corner{static_cast<double>(cell.column), static_cast<double>(cell.row)};
  Piece piece{cell, 0.0, {}, {}};
  Outline local;
  for (const Vec2& v : polygon) local.push_back(v - corner);
  const Moments m = moments(local);
  if (m.area >= 1.0 - negligible) return {.cell = cell};
  piece.area = m.area;
  if (m.area < negligible) return piece;
  piece.centroid = (1.0 / m.area) * m.first;
  for (std::size_t k = 0; k < local.size(); ++k) {
    const Vec2 a = local[k], b = local[(k + 1) % local.size()];
    if (a.x == 1.0 && b.x == 1.0) piece.side[0] += b.y - a.y;
    if (a.y == 1.0 && b.y == 1.0) piece.side[1] += a.x - b.x;
    if (a.x == 0.0 && b.x == 0.0) piece.side[2] += a.y - b.y;
    if (a.y == 0.0 && b.y == 0.0) piece.side[3] += b.x - a.x;
  }
  return piece;
}

/// Cuts a polygon in lattice coordinates into the cells from `lo` up to, not including, `hi`, by halves.
void cut_into_cells(const Outline& polygon, CellIndex lo, CellIndex hi, std::vector<Piece>& pieces) {
  if (polygon.size() < 3) return;
  const std::int64_t rows = hi.row - lo.row, columns = hi.column - lo.column;
  if (rows == 1 && columns == 1) {
    const Piece piece = cut_piece(polygon, lo);
    if (piece.area >= negligible) pieces.push_back(piece);
    return;
  }
  const bool upright = rows >= columns;
  const std::int64_t middle = upright ? lo.row + rows / 2 : lo.column + columns / 2;
  double Vec2::*const axis = upright ? &Vec2::y : &Vec2::x;
  const auto at = static_cast<double>(middle);
  cut_into_cells(clip(polygon, axis, at, -1.0), lo, upright ? CellIndex{middle, hi.column} : CellIndex{hi.row, middle},
                 pieces);
  cut_into_cells(clip(polygon, axis, at, 1.0), upright ? CellIndex{middle, lo.column} : CellIndex{lo.row, middle}, hi,
                 pieces);
}

/// The pieces of one outline, joined until none is smaller than least_cells.
class Joined {
 public:
  explicit Joined(std::vector<Piece> pieces) : pieces_(std::move(pieces)), group_(pieces_.size()) {
    std::sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return a.cell < b.cell; });
    std::iota(group_.begin(), group_.end(), std::size_t{0});
    for (std::size_t k = 0; k < pieces_.size(); ++k) members_.push_back({k});
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      while (group_[k] == k && area(k) < least_cells - negligible && join_longest(k)) {
      }
  }

  /// One piece for each group: the cell of its first, area and centroid of all.
  std::vector<Piece> groups() const {
    std::vector<Piece> out;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (group_[k] != k) continue;
      if (members_[k].size() == 1) {
        out.push_back(pieces_[k]);
        continue;
      }
      Piece sum{pieces_[k].cell, area(k), {}, {}};
      for (const std::size_t j : members_[k]) sum.centroid += (pieces_[j].area / sum.area) * place(j, sum.cell);
      out.push_back(sum);
    }
    return out;
  }

 private:
  double area(std::size_t group) const {
    double sum = 0.0;
    for (const std::size_t j : members_[group]) sum += pieces_[j].area;
    return sum;
  }
  /// Centroid of a piece from the corner of another cell.
  Vec2 place(std::size_t j, CellIndex from) const {
    const CellIndex cell = pieces_[j].cell;
    return pieces_[j].centroid +
           Vec2{static_cast<double>(cell.column - from.column), static_cast<double>(cell.row - from.row)};
  }
  /// The piece of a cell, or none: pieces_.size().
  std::size_t find(CellIndex cell) const {
    const auto at = std::lower_bound(pieces_.begin(), pieces_.end(), cell,
                                     [](const Piece& piece, CellIndex c) { return piece.cell < c; });
    return at != pieces_.end() && at->cell == cell ? static_cast<std::size_t>(at - pieces_.begin()) : pieces_.size();
  }
  /// Joins a group to the one behind its longest edge. @return whether there is one
  bool join_longest(std::size_t group) {
    double longest = negligible;
    std::size_t to = pieces_.size();
    for (const std::size_t j : members_[group])
      for (std::size_t s = 0; s < neighbour_cells.size(); ++s) {
        const CellIndex step = neighbour_cells[s], cell = pieces_[j].cell;
        if (pieces_[j].side[s] <= longest + negligible) continue;
        const std::size_t other = find({cell.row + step.row, cell.column + step.column});
        if (other == pieces_.size() || group_[other] == group) continue;
        longest = pieces_[j].side[s];
        to = group_[other];
      }
    if (to == pieces_.size()) return false;
    // The heavier group keeps its place in the order.
    for (const std::size_t j : members_[group]) {
      group_[j] = to;
      members_[to].push_back(j);
    }
    members_[group].clear();
    return true;
  }

  std::vector<Piece> pieces_;                      ///< by cell
  std::vector<std::size_t> group_;                 ///< of each piece: the index of the group's first piece
  std::vector<std::vector<std::size_t>> members_;  ///< of each group
};

/// The slide's outlines in lattice coordinates, counter-clockwise.
std::vector<SlidePart> in_lattice_coordinates(std::span<const SlidePart> slide, const LatticeFrame& frame) {
  std::vector<SlidePart> out(slide.begin(), slide.end());
  for (SlidePart& part : out) {
    std::ranges::transform(part.outline, part.outline.begin(), [&](Vec2 v) { return frame.from_plane(v); });
    if (signed_area(part.outline) < 0.0) std::ranges::reverse(part.outline);
  }
  return out;
}

/// @param box  bounding box of the slide, in lattice coordinates as the outline
std::vector<Piece> cut_outline(const Outline& outline, const Box& box) {
  const auto first = [](double at) { return static_cast<std::int64_t>(std::floor(at + negligible)); };
  const auto end = [](double at) { return static_cast<std::int64_t>(std::ceil(at - negligible)) + 1; };
  std::vector<Piece> pieces;
  cut_into_cells(outline, {first(box.lo.y), first(box.lo.x)}, {end(box.hi.y), end(box.hi.x)}, pieces);
  return Joined(std::move(pieces)).groups();
}

/// The point, or the nearest one found that is `distance` away from the walls.
Vec2 clear_of_walls(Vec2 x, double distance, const Ground& ground) {
  constexpr int surfaces = 4;  // in a corner
  for (int k = 0; k < surfaces; ++k) {
    const Ground::Nearest near = ground.nearest(x);
    if (near.past_end || near.distance >= distance) break;
    x = near.point + distance * near.normal;
  }
  return x;
}

std::vector<SoilPoint> fill_with_cut_cells(std::span<const SlidePart> slide, const Ground& ground, double dx,
                                           const Lattice& lattice) {
  const LatticeFrame frame(bounding_box(slide).lo, dx, lattice);
  const std::vector<SlidePart> parts = in_lattice_coordinates(slide, frame);
  const Box box = bounding_box(parts);
  struct Placed {
    CellIndex cell;
    SoilPoint point;
  };
  std::vector<Placed> placed;
  for (const SlidePart& part : parts)
    for (const Piece& piece : cut_outline(part.outline, box)) {
      const Vec2 x = frame.to_plane({static_cast<double>(piece.cell.column) + piece.centroid.x,
                                     static_cast<double>(piece.cell.row) + piece.centroid.y});
      placed.push_back({piece.cell, {clear_of_walls(x, least_distance * dx, ground), part.material, piece.area}});
    }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.cell < b.cell; });
  std::vector<SoilPoint> points;
  for (const Placed& p : placed) points.push_back(p.point);
  return points;
}

std::vector<SoilPoint> fill_with_lattice_points(std::span<const SlidePart> slide, const Ground& ground, double dx,
                                                bool nodes) {
  const Box box = bounding_box(slide);
  const double shift = nodes ? 0.0 : 0.5, tolerance = negligible * dx;
  const auto columns = static_cast<std::int64_t>(std::floor(box.width() / dx + negligible)) + 1;
  const auto rows = static_cast<std::int64_t>(std::floor(box.height() / dx + negligible)) + 1;
  std::vector<Polygon> polygons;
  for (const SlidePart& part : slide) polygons.push_back(to_polygon(part.outline));
  std::vector<SoilPoint> points;
  for (std::int64_t row = 0; row < rows; ++row)
    for (std::int64_t column = 0; column < columns; ++column) {
      const Vec2 x{box.lo.x + (static_cast<double>(column) + shift) * dx,
                   box.lo.y + (static_cast<double>(row) + shift) * dx};
      // Lattice nodes that fall on the far edges would be lost to rounding: test a point slightly inside.
      const Vec2 probe = nodes ? Vec2{std::clamp(x.x, box.lo.x + tolerance, box.hi.x - tolerance),
                                      std::clamp(x.y, box.lo.y + tolerance, box.hi.y - tolerance)}
                               : x;
      for (std::size_t k = 0; k < slide.size(); ++k) {
        if (!boost::geometry::covered_by(probe, polygons[k])) continue;
        if (ground.nearest(x).distance >= 0.5 * dx - tolerance) points.push_back({x, slide[k].material});
        break;
      }
    }
  return points;
}

Vec2 mirrored(Vec2 v) { return {-v.x, v.y}; }

std::vector<SlidePart> mirrored(std::span<const SlidePart> slide) {
  std::vector<SlidePart> out(slide.begin(), slide.end());
  for (SlidePart& part : out)
    std::ranges::transform(part.outline, part.outline.begin(), [](Vec2 v) { return mirrored(v); });
  return out;
}

/// In reverse order, so that the soil stays on the left.
std::vector<Polyline> mirrored(std::span<const Polyline> lines) {
  std::vector<Polyline> out(lines.begin(), lines.end());
  for (Polyline& line : out) {
    std::ranges::transform(line.vertices, line.vertices.begin(), [](Vec2 v) { return mirrored(v); });
    std::ranges::reverse(line.vertices);
  }
  return out;
}

}  // namespace

std::vector<SoilPoint> fill_slide(std::span<const SlidePart> slide, std::span<const Polyline> walls, double dx,
                                  Placement placement, SlidesTo slides_to, const Lattice& lattice) {
  if (slides_to == SlidesTo::left) {
    std::vector<SoilPoint> points =
        fill_slide(mirrored(slide), mirrored(walls), dx, placement, SlidesTo::right, lattice);
    for (SoilPoint& p : points) p.x = mirrored(p.x);
    return points;
  }
  const Ground ground({walls.begin(), walls.end()});
  if (placement == Placement::cells) return fill_with_cut_cells(slide, ground, dx, lattice);
  return fill_with_lattice_points(slide, ground, dx, placement == Placement::nodes);
}

}  // namespace talus

// What of the outlines is slide: what lies in the ground, in an outline before, or in a film that no particle resolves
// is cut off.

#include <algorithm>
#include <cmath>

#include "case/outline.hpp"
#include "case/overlay.hpp"
#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr double negligible_cells = 1e-3;  ///< of a particle: so much overlap is rounding, and the outline is kept
constexpr double told_share = 1e-3;        ///< of an outline's area: less is cut off without a warning

/// Soil thinner than half a spacing makes no particle of its own: the least piece of a cell is half a cell.
constexpr double film_thickness = 0.5;  ///< vertical [dx]
/// A toe that thins out is shorter, unless it is flatter than 1 : 20.
constexpr double film_length = 10.0;  ///< [dx]

std::string describe_share(double part, double whole) {
  return rounded(part) + " m2 (" + rounded(100.0 * part / whole) + " %)";
}

/// A place to the centimetre, also where it is a coordinate of a national grid.
std::string centimetres(double x) { return to_text(std::round(100.0 * x) / 100.0); }

/// The outline in pieces, or as it is where so little is cut off that it is rounding.
/// @param what  of the outline lies where it may not, such as "in the ground"
Pieces cut_off(const std::vector<Vec2>& outline, std::optional<Pieces> rest, double lost, double whole,
               const std::string& source, const std::string& what, std::vector<Fault>& warnings) {
  const bool told = lost > told_share * whole;
  if (!rest && !told) return {outline};
  if (!rest)
    throw ConfigError(source, "has " + describe_share(lost, whole) + " " + what +
                                  ", which cannot be cut off; let the outline follow the boundary there");
  if (told) warnings.push_back({source, "has " + describe_share(lost, whole) + " " + what + ", which are cut off"});
  return *rest;
}

Pieces above_ground(const std::vector<Vec2>& outline, std::span<const Vec2> room, const std::string& source, double dx,
                    std::vector<Fault>& warnings) {
  const AreaSplit split = split_area(outline, room);
  if (split.outside <= negligible_cells * dx * dx) return {outline};
  return cut_off(outline, pieces_inside(outline, room), split.outside, split.inside + split.outside, source,
                 "in the ground", warnings);
}

/// Pieces of an outline outside those before it.
Pieces apart(Pieces pieces, std::span<const SlidePart> before, std::span<const std::string> sources,
             const std::string& source, double dx, std::vector<Fault>& warnings) {
  for (std::size_t k = 0; k < before.size(); ++k) {
    Pieces left;
    for (const auto& piece : pieces) {
      const AreaSplit split = split_area(piece, before[k].outline);
      if (split.inside <= negligible_cells * dx * dx)
        left.push_back(piece);
      else
        std::ranges::move(cut_off(piece, pieces_outside(piece, before[k].outline), split.inside,
                                  split.inside + split.outside, source, "in " + sources[k] + " too", warnings),
                          std::back_inserter(left));
    }
    pieces = std::move(left);
  }
  return pieces;
}

/// A stretch of a slide along x.
struct ThinStretch {
  double from, to;
  double soil = 0.0;  ///< length with soil
};

/// Stretches thinner than `limit`, from left to right.
std::vector<ThinStretch> thin_stretches(std::span<const SlidePart> slide, double limit) {
  std::vector<ThinStretch> thin;
  const auto add = [&](double from, double to, bool soil) {
    if (thin.empty() || thin.back().to != from) thin.push_back({from, from});
    ThinStretch& last = thin.back();
    last.to = to;
    last.soil += soil ? to - from : 0.0;
  };
  for (const ThicknessStrip& s : thickness_strips(slide)) {
    const auto [least, greatest] = std::minmax(s.at_x0, s.at_x1);
    if (least >= limit) continue;
    const double middle = s.x0 + (s.x1 - s.x0) * (limit - s.at_x0) / (s.at_x1 - s.at_x0);
    if (greatest < limit)
      add(s.x0, s.x1, greatest > 0.0);
    else if (s.at_x0 < limit)
      add(s.x0, middle, true);
    else
      add(middle, s.x1, true);
  }
  return thin;
}

/// Without what lies between two x.
std::vector<SlidePart> without_stretch(const std::vector<SlidePart>& slide, const ThinStretch& film, const Box& box) {
  const double lo = film.from == box.lo.x ? box.lo.x - 1.0 : film.from;
  const double hi = film.to == box.hi.x ? box.hi.x + 1.0 : film.to;
  const std::vector<Vec2> band = {
      {lo, box.lo.y - 1.0}, {hi, box.lo.y - 1.0}, {hi, box.hi.y + 1.0}, {lo, box.hi.y + 1.0}};
  std::vector<SlidePart> rest;
  for (const SlidePart& part : slide)
    for (auto& piece : pieces_outside(part.outline, band).value_or(Pieces{part.outline}))
      rest.push_back({std::move(piece), part.material});
  return rest;
}

double soil_area(std::span<const SlidePart> slide) {
  double sum = 0.0;
  for (const SlidePart& part : slide) sum += area(part.outline);
  return sum;
}

/// Leaves films out, unless the slide is nothing else.
void leave_films_out(Model& model, std::vector<Fault>& warnings) {
  const Box box = bounding_box(model.slide);
  for (const ThinStretch& film : thin_stretches(model.slide, film_thickness * model.dx)) {
    if (film.soil < film_length * model.dx) continue;
    std::vector<SlidePart> rest = without_stretch(model.slide, film, box);
    const double before = soil_area(model.slide), lost = before - soil_area(rest);
    if (lost <= negligible_cells * model.dx * model.dx || before - lost < model.dx * model.dx) continue;
    model.left_out += mass_of(model.slide, model.materials) - mass_of(rest, model.materials);
    model.slide = std::move(rest);
    const double origin = model.terrain.origin.x;
    warnings.push_back(
        {"/slide", "is thinner than half a particle spacing from x = " + centimetres(film.from + origin) +
                       " m to x = " + centimetres(film.to + origin) + " m, " + rounded(lost / film.soil) +
                       " m on average: " + describe_share(lost, before) +
                       " are left out there; take a smaller spacing, or let the slip surface end "
                       "where the slide does"});
  }
}

}  // namespace

void trim_slide(Model& model, const SourceLocations& origins, std::vector<Fault>& warnings) {
  const Terrain& terrain = model.terrain;
  const std::vector<Vec2> room = terrain.closed ? terrain.bed : room_above(terrain.bed, bounding_box(model.slide).hi.y);
  std::vector<SlidePart> slide;
  std::vector<std::string> sources;  // of each part of `slide`
  for (std::size_t k = 0; k < model.slide.size(); ++k) {
    const std::string& source = origins.outlines[k].source;
    Pieces pieces = above_ground(model.slide[k].outline, room, source, model.dx, warnings);
    for (auto& piece : apart(std::move(pieces), slide, sources, source, model.dx, warnings)) {
      slide.push_back({std::move(piece), model.slide[k].material});
      sources.push_back(source);
    }
  }
  if (soil_area(slide) < model.dx * model.dx)
    throw ConfigError("/slide", "lies in the ground: less than one particle is left above the bed");
  model.slide = std::move(slide);
  leave_films_out(model, warnings);
}

}  // namespace talus

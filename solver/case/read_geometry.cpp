// The keys of terrain and slide: polylines, their shape, and the outlines between ground and slip surface.

#include <algorithm>
#include <cmath>

#include "case/outline.hpp"
#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Names<bool> ends[] = {{"wall", true}, {"open", false}};
constexpr Names<SlidesTo> directions[] = {{"right", SlidesTo::right}, {"left", SlidesTo::left}};

/// A ring whose first vertex is repeated at the end loses the repetition.
void open_ring(Vertices& ring) {
  if (ring.points.size() < 2 || !(ring.points.front() == ring.points.back())) return;
  ring.points.pop_back();
  if (!ring.lines.empty()) ring.lines.pop_back();
}

/// Faults of a ring or polyline that crosses itself.
bool check_simple(const Vertices& v, bool closed, Faults& faults) {
  const auto crossing = self_intersection(v.points, closed);
  if (!crossing) return true;
  const Vec2 from = v.points[crossing->second], to = v.points[(crossing->second + 1) % v.points.size()];
  faults.add(v.location(crossing->second), crossing->first == crossing->second
                                               ? "repeats the vertex before or after it, " + to_text(from)
                                               : "starts an edge, " + to_text(from) + " to " + to_text(to) +
                                                     ", that crosses or touches the edge from vertex " +
                                                     std::to_string(crossing->first) + ", " +
                                                     to_text(v.points[crossing->first]));
  return false;
}

/// Faults of a surface that does not run from left to right.
bool check_left_to_right(const Vertices& v, bool steps_allowed, Faults& faults) {
  for (std::size_t k = 1; k < v.points.size(); ++k) {
    const double before = v.points[k - 1].x, x = v.points[k].x;
    if (x > before || (steps_allowed && x == before)) continue;
    faults.add(v.location(k), "x = " + to_text(x) + " does not exceed the x before it, " + to_text(before) +
                                  ": vertices must run from left to right");
    return false;
  }
  return true;
}

/// A ring with an area, that does not cross itself.
bool check_ring(Vertices& ring, Faults& faults) {
  open_ring(ring);
  if (ring.points.size() < 3) {
    faults.add(ring.source, "has fewer than 3 different vertices");
    return false;
  }
  return check_simple(ring, true, faults);
}

int index_of(const Material& m, std::vector<Material>& materials) {
  auto found = std::find(materials.begin(), materials.end(), m);
  if (found == materials.end()) found = materials.insert(found, m);
  return static_cast<int>(found - materials.begin());
}

/// A material of its own takes from `fallback` what it does not name.
void read_outline(ObjectReader& in, const std::filesystem::path& directory, const MaterialInput& fallback,
                  SlideInput& slide) {
  Vertices outline = read_vertices(in, "outline", {3, most_vertices}, directory,
                                   {"Vertices [x, y] in order, clockwise or counter-clockwise; no crossing; not below "
                                    "the bed.",
                                    "survey"});
  in.one_form({{{"outline_m"}}, {{"outline_csv"}}});
  int material = 0;
  in.object("material", "What differs from the default material in this outline, for layered slides.", Absent::skip,
            [&](ObjectReader& own) {
              MaterialInput m = fallback;
              own.describe_defaults_as("the default material's");
              read_material(own, m);
              material = index_of(m, slide.materials);
            });
  const bool sound = !outline.empty() && check_ring(outline, in.faults());
  in.record("outline_m", to_json(outline.points));
  if (!sound) return;
  slide.parts.push_back({outline.points, material});
  slide.origins.push_back(std::move(outline));
}

/// What a survey gives: the ground before the slide, and the surface it slides on.
void cut_outlines(ObjectReader& in, const Vertices& ground, const Vertices& slip, SlideInput& slide) {
  Json resolved = Json::array();
  const bool ground_sound = !ground.empty() && check_left_to_right(ground, true, in.faults());
  const bool slip_sound = !slip.empty() && check_left_to_right(slip, true, in.faults());
  if (ground_sound && slip_sound) {
    for (auto& outline : between_surfaces(ground.points, slip.points)) {
      resolved.push_back({{"outline_m", to_json(outline)}});
      slide.origins.push_back({outline, slip.source});
      slide.parts.push_back({std::move(outline), 0});
    }
    if (slide.parts.empty()) in.fault("", "holds no soil: no part of the slip surface lies below the ground surface");
  }
  in.record("outlines", std::move(resolved));
}

/// The way the bed falls from one end of the slide to the other; on level ground away from the wall at its end.
SlidesTo downhill(ObjectReader& in, const Terrain& t, const SlideInput& slide, double dx) {
  if (t.closed || t.bed.empty() || slide.parts.empty()) return SlidesTo::right;
  const Box box = bounding_box(slide.parts);
  const double fall = bed_height(t.bed, box.lo.x) - bed_height(t.bed, box.hi.x);
  if (std::abs(fall) > 0.1 * dx) return fall > 0.0 ? SlidesTo::right : SlidesTo::left;
  const auto stands = [&](const char* key, bool otherwise) {
    const Json* end = in.find(key);
    return end == nullptr ? otherwise : *end == "wall";
  };
  const bool held_left = stands("left_end", true) && box.lo.x < t.bed.front().x + dx;
  const bool held_right = stands("right_end", false) && box.hi.x > t.bed.back().x - dx;
  return held_right && !held_left ? SlidesTo::left : SlidesTo::right;
}

void read_run_out(ObjectReader& in, Terrain& t, const SlideInput& slide, double dx) {
  t.run_out.to = downhill(in, t, slide, dx);
  in.choice("slides_to", t.run_out.to, directions,
            {"The way the slide goes and run-outs are measured.", "site",
             "the side to which the bed falls from one end of the slide to the other; on level ground away from the "
             "wall at the slide's end, otherwise right; right in a closed bed"});
  if (!t.bed.empty()) {
    const auto [left, right] = std::ranges::minmax(t.bed, {}, &Vec2::x);
    t.run_out.from = t.run_out.to == SlidesTo::right ? left.x : right.x;
  }
  in.number("measured_from_m", t.run_out.from, coordinate,
            {"x from which run-outs are measured, in the direction of slides_to.", "[Z20] section 4",
             "the bed's uphill end: its least x, or its greatest if the slide goes to the left"});
}

/// By default 5 particle spacings over the slide and over the walled ends of the bed.
void read_wall_top(ObjectReader& in, Terrain& t, const SlideInput& slide, double dx) {
  const double highest = slide.parts.empty() ? coordinate.lo : bounding_box(slide.parts).hi.y;
  const double left = t.left_wall && !t.bed.empty() ? t.bed.front().y : coordinate.lo;
  const double right = t.right_wall && !t.bed.empty() ? t.bed.back().y : coordinate.lo;
  const double bed = std::max(left, right);
  t.wall_top = std::clamp(std::max(highest, bed) + 5.0 * dx, coordinate.lo, coordinate.hi);
  in.number("wall_top_m", t.wall_top, coordinate,
            {"Height y of the top of the end walls; above the bed there. Open beds only.", "site",
             "5 particle spacings over the highest point of slide and walled bed ends"});
  if (t.wall_top <= bed && in.faults().none_under(in.pointer("wall_top_m")))
    in.fault("wall_top_m", to_text(t.wall_top) + " does not lie above the bed at the walled end, y = " + to_text(bed));
}

void read_ends(ObjectReader& in, Terrain& t, const SlideInput& slide, double dx) {
  if (t.closed) {
    for (const char* key : {"left_end", "right_end", "wall_top_m"})
      if (in.find(key) != nullptr) in.fault(key, "has no meaning for a closed bed");
    return;
  }
  t.left_wall = t.run_out.to == SlidesTo::right;
  t.right_wall = !t.left_wall;
  in.choice("left_end", t.left_wall, ends,
            {"What stands on the bed's first vertex: a vertical wall, or nothing. Open beds only.", "site",
             "wall, or open if the slide goes to the left"});
  in.choice("right_end", t.right_wall, ends,
            {"What stands on the bed's last vertex: a vertical wall, or nothing. Open beds only.", "site",
             "open, or wall if the slide goes to the left"});
  read_wall_top(in, t, slide, dx);
}

}  // namespace

SlideInput read_slide(ObjectReader& in, const std::filesystem::path& directory, const MaterialInput& fallback) {
  SlideInput slide{{}, {}, {fallback}};
  const bool outlines = in.find("outlines") != nullptr;
  const auto given = [&](const char* key) { return in.find(key) != nullptr; };
  const bool ground_given = given("ground_surface_m") || given("ground_surface_csv");
  const bool surfaces = given("slip_surface_m") || given("slip_surface_csv") || ground_given;
  const bool by_surfaces = surfaces && !outlines;
  if (outlines && surfaces) in.fault("", "is given both by outlines and by surfaces; give one of the two");
  if (!outlines && !surfaces) in.fault("outlines", "is missing (or ground_surface_m and slip_surface_m)");
  in.objects("outlines", {1, 100}, {"Closed outlines that do not overlap, each of one material.", "survey"},
             "One closed outline. Give outline_m or outline_csv.",
             [&](ObjectReader& outline) { read_outline(outline, directory, fallback, slide); });
  const Vertices ground =
      read_vertices(in, "ground_surface", {2, most_vertices}, directory,
                    {"Ground surface before the slide, from left to right.", "survey"}, by_surfaces);
  const Vertices slip = read_vertices(in, "slip_surface", {2, most_vertices}, directory,
                                      {"Slip surface, from left to right; soil between it and the ground surface "
                                       "slides, in one or several pieces.",
                                       "survey"},
                                      by_surfaces);
  in.one_form({{{"outlines"}},
               {{"ground_surface_m", "slip_surface_m"}},
               {{"ground_surface_m", "slip_surface_csv"}},
               {{"ground_surface_csv", "slip_surface_m"}},
               {{"ground_surface_csv", "slip_surface_csv"}}});
  if (by_surfaces) cut_outlines(in, ground, slip, slide);
  return slide;
}

void read_terrain(ObjectReader& in, Terrain& t, const std::filesystem::path& directory, const SlideInput& slide,
                  double dx, Vertices& bed) {
  bed = read_vertices(
      in, "bed", {2, most_vertices}, directory,
      {"Bed polyline [x, y]. Open: x strictly increasing, soil above it; closed: a ring with the soil inside.",
       "survey"});
  in.one_form({{{"bed_m"}}, {{"bed_csv"}}});
  in.flag("closed", t.closed, {"The bed is a ring, its last vertex joined to its first.", "survey"});
  const bool sound =
      !bed.empty() && (t.closed ? check_ring(bed, in.faults()) : check_left_to_right(bed, false, in.faults()));
  if (!sound) bed.points.clear();
  t.bed = bed.points;
  if (t.closed && signed_area(t.bed) < 0.0) std::reverse(t.bed.begin(), t.bed.end());
  in.record("bed_m", to_json(t.bed));
  read_run_out(in, t, slide, dx);
  read_ends(in, t, slide, dx);
}

}  // namespace talus

// The keys of terrain and slide: polylines, their shape, and the outlines between ground and slip surface.

#include <algorithm>
#include <cmath>

#include "case/joined_bed.hpp"
#include "case/outline.hpp"
#include "case/sections.hpp"
#include "math/angle.hpp"
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

/// Faults of a surface that does not run from left to right; vertical faces are allowed.
bool check_left_to_right(const Vertices& v, Faults& faults) {
  for (std::size_t k = 1; k < v.points.size(); ++k) {
    const double before = v.points[k - 1].x, x = v.points[k].x;
    if (x >= before) continue;
    faults.add(v.location(k), "x = " + to_text(x) + " is less than the x before it, " + to_text(before) +
                                  ": vertices must run from left to right");
    return false;
  }
  if (v.points.front().x < v.points.back().x) return true;
  faults.add(v.source, "has no extent: every x is " + to_text(v.points.front().x));
  return false;
}

/// Faults of an open bed. It may have vertical faces and overhangs, but begins at its left end and ends at its right
/// one, with free air above both, and does not cross or touch itself.
bool check_open_bed(const Vertices& bed, Faults& faults) {
  const double left = bed.points.front().x, right = bed.points.back().x;
  const auto refuse = [&](std::size_t k, const std::string& where) {
    faults.add(bed.location(k), "x = " + to_text(bed.points[k].x) + " lies " + where +
                                    ": a bed runs from its left end to its right end");
    return false;
  };
  if (right <= left) return refuse(bed.points.size() - 1, "not to the right of the first vertex, x = " + to_text(left));
  for (std::size_t k = 1; k < bed.points.size(); ++k)
    if (bed.points[k].x < left || bed.points[k].x > right)
      return refuse(k, "beyond an end of the bed, x = " + to_text(left) + " to " + to_text(right));
  if (!check_simple(bed, false, faults)) return false;
  if (!self_intersection(room_above(bed.points, bed.points.front().y), true)) return true;
  faults.add(bed.source,
             "has no free air above its first or last vertex: soil lies on the left of the bed as it is "
             "walked, so an end may not stand beneath the bed or below a vertical face");
  return false;
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
  in.object("material", "Properties in this outline that differ from the default material, for layered slides.",
            Absent::skip, [&](ObjectReader& own) {
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
  const bool ground_sound = !ground.empty() && check_left_to_right(ground, in.faults());
  const bool slip_sound = !slip.empty() && check_left_to_right(slip, in.faults());
  if (ground_sound && slip_sound) {
    for (auto& outline : between_surfaces(ground.points, slip.points)) {
      resolved.push_back({{"outline_m", to_json(outline)}});
      slide.origins.push_back({outline, slip.source});
      slide.parts.push_back({std::move(outline), 0});
    }
    slide.ground = ground;
    slide.slip = slip;
    if (slide.parts.empty()) in.fault("", "holds no soil: no part of the slip surface lies below the ground surface");
  }
  in.record("outlines", std::move(resolved));
}

/// The downhill side of the bed between the ends of the slide; on level ground the side away from an end wall that
/// holds the slide.
SlidesTo downhill(ObjectReader& in, const Terrain& t, const SlideInput& slide, double dx) {
  if (t.closed || t.bed.empty() || slide.parts.empty()) return SlidesTo::right;
  const Box box = bounding_box(slide.parts);
  const auto height = [&](double x) {
    return height_beneath(t.bed, {std::clamp(x, t.bed.front().x, t.bed.back().x), box.hi.y});
  };
  const double fall = height(box.lo.x) - height(box.hi.x);
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
  in.choice(
      "slides_to", t.run_out.to, directions,
      {"Direction in which the slide moves and run-outs are measured.", "site",
       "downhill along the bed between the ends of the slide; on level ground away from an end wall that holds the "
       "slide, otherwise right; right in a closed bed"});
  if (!t.bed.empty()) {
    const auto [left, right] = std::ranges::minmax(t.bed, {}, &Vec2::x);
    t.run_out.from = t.run_out.to == SlidesTo::right ? left.x : right.x;
  }
  in.number("measured_from_m", t.run_out.from, coordinate,
            {"x from which run-outs are measured, in the direction of slides_to.", "[Z20] section 4",
             "the bed's uphill end: its least x, or its greatest if the slide goes to the left"});
  t.front_thickness = default_front_thickness(dx);
  in.number(
      "front_thickness_m", t.front_thickness, {"m", 0.0, 1e6, true},
      {"Thickness of the soil, measured vertically, at the front that front_at_thickness_m states: the farthest "
       "place of the deposit that is at least that thick. To compare particle spacings give one thickness for all.",
       "user", "0.1 m or 1.5 particle spacings, whichever is more"});
}

/// The top of an end wall, where it is stated for that end.
void read_own_top(ObjectReader& in, std::string_view key, const char* side, bool stands, std::optional<double>& top) {
  in.optional_number(
      key, top, coordinate,
      {std::string("Height y of the top of the ") + side + " end wall; above the bed there. Open beds only.", "site",
       "wall_top_m"});
  if (top && !stands) in.fault(key, std::string("has no meaning: no wall stands on the ") + side + " end");
}

/// By default 5 particle spacings over the slide and over the walled ends of the bed.
void read_wall_tops(ObjectReader& in, Terrain& t, const SlideInput& slide, double dx) {
  const double highest = slide.parts.empty() ? coordinate.lo : bounding_box(slide.parts).hi.y;
  const double left = t.left_wall && !t.bed.empty() ? t.bed.front().y : coordinate.lo;
  const double right = t.right_wall && !t.bed.empty() ? t.bed.back().y : coordinate.lo;
  t.wall_top = std::clamp(std::max({highest, left, right}) + 5.0 * dx, coordinate.lo, coordinate.hi);
  in.number("wall_top_m", t.wall_top, coordinate,
            {"Height y of the top of the end walls; above the bed there. Open beds only.", "site",
             "5 particle spacings over the highest point of slide and walled bed ends"});
  read_own_top(in, "left_wall_top_m", "left", t.left_wall, t.left_top);
  read_own_top(in, "right_wall_top_m", "right", t.right_wall, t.right_top);
  const auto check = [&](std::string_view key, double top, double bed) {
    if (top <= bed && in.faults().none_under(in.pointer(key)))
      in.fault(key, to_text(top) + " does not lie above the bed at the walled end, y = " + to_text(bed));
  };
  check("wall_top_m", t.wall_top, std::max(t.left_top ? coordinate.lo : left, t.right_top ? coordinate.lo : right));
  if (t.left_top) check("left_wall_top_m", *t.left_top, left);
  if (t.right_top) check("right_wall_top_m", *t.right_top, right);
}

void read_ends(ObjectReader& in, Terrain& t, const SlideInput& slide, double dx) {
  if (t.closed) {
    for (const char* key : {"left_end", "right_end", "wall_top_m", "left_wall_top_m", "right_wall_top_m"})
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
  read_wall_tops(in, t, slide, dx);
}

/// The bed that the slide's surfaces leave, or nothing and a fault.
Vertices join_surfaces(ObjectReader& in, const SlideInput& slide, const Vertices& beyond, bool closed) {
  if (closed) {
    in.fault("bed_m", "is missing (or bed_csv): a closed bed is not joined from surfaces");
  } else if (slide.ground.empty()) {
    if (slide.by_outlines) in.fault("bed_m", "is missing (or bed_csv): a slide that is given by outlines needs a bed");
  } else if (!slide.parts.empty() && (beyond.empty() || check_left_to_right(beyond, in.faults()))) {
    return {joined_bed(slide.ground.points, slide.slip.points, beyond.points, bounding_box(slide.parts)),
            "the bed joined from the surfaces of the slide"};
  }
  return {};
}

}  // namespace

void read_lattice(ObjectReader& in, Model& m) {
  constexpr Quantity share_of_a_cell{"spacings", 0.0, 1.0, false, true};
  double angle_deg = 0.0;
  in.number(
      "shift_x_spacings", m.lattice.shift.x, share_of_a_cell,
      {"Shift of the lattice along its rows, from the lower left corner of the slide's bounding box.", "numerical"});
  in.number("shift_y_spacings", m.lattice.shift.y, share_of_a_cell, {"The same across its rows.", "numerical"});
  in.number("angle_deg", angle_deg, {"deg", -90.0, 90.0},
            {"Angle by which the lattice is turned about that corner, counter-clockwise.", "numerical"});
  m.lattice.angle = radians(angle_deg);
  if (m.placement != Placement::cells)
    in.fault("", "needs particle_placement \"cells\", which keeps the mass of the outlines on any lattice");
}

SlideInput read_slide(ObjectReader& in, const std::filesystem::path& directory, const MaterialInput& fallback) {
  SlideInput slide;
  slide.materials = {fallback};
  const bool outlines = in.find("outlines") != nullptr;
  const auto given = [&](const char* key) { return in.find(key) != nullptr; };
  const bool ground_given = given("ground_surface_m") || given("ground_surface_csv");
  const bool surfaces = given("slip_surface_m") || given("slip_surface_csv") || ground_given;
  const bool by_surfaces = surfaces && !outlines;
  slide.by_outlines = outlines;
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
                  double dx, SourceLocations& origins) {
  Vertices& bed = origins.bed;
  bed = read_vertices(in, "bed", {2, most_vertices}, directory,
                      {"Bed polyline [x, y]. Open: from its left end to its right end with the soil on its left as it "
                       "is walked, vertical faces and overhangs allowed; closed: a ring with the soil inside. Not "
                       "needed with slide.ground_surface and slide.slip_surface: the bed is then the lower of the two.",
                       "survey"},
                      false);
  const Vertices beyond =
      read_vertices(in, "ground_beyond", {2, most_vertices}, directory,
                    {"Ground outside the slide where it differs from slide.ground_surface, from left to right; only "
                     "without a bed.",
                     "survey"},
                    false);
  origins.note_file(bed);
  origins.note_file(beyond);
  in.one_form({{{"bed_m"}}, {{"bed_csv"}}, {{"ground_beyond_m"}}, {{"ground_beyond_csv"}}, {{}}});
  in.flag("closed", t.closed, {"The bed is a ring, its last vertex joined to its first.", "survey"});
  const auto given = [&](const char* key) { return in.find(key) != nullptr; };
  const bool bed_given = given("bed_m") || given("bed_csv");
  if (!bed_given) bed = join_surfaces(in, slide, beyond, t.closed);
  for (const char* key : {"ground_beyond_m", "ground_beyond_csv"})
    if (bed_given && given(key)) in.fault(key, "is given beside a bed; the bed holds the ground beyond the slide");
  const bool sound = !bed.empty() && (t.closed ? check_ring(bed, in.faults()) : check_open_bed(bed, in.faults()));
  if (!sound) bed.points.clear();
  t.bed = bed.points;
  if (t.closed && signed_area(t.bed) < 0.0) std::reverse(t.bed.begin(), t.bed.end());
  in.record("bed_m", to_json(t.bed));
  read_run_out(in, t, slide, dx);
  read_ends(in, t, slide, dx);
}

}  // namespace talus

// Terrain and slide: polylines, their shape, and the outlines between ground and slip surface.

#include <algorithm>
#include <cmath>

#include "case/outline.hpp"
#include "case/sections.hpp"
#include "case/words.hpp"

namespace talus {
namespace {

constexpr Quantity coordinate{"m", -1e6, 1e6};
constexpr std::size_t most_outlines = 100;

enum class End { wall, open };
constexpr Names<End> ends[] = {{"wall", End::wall}, {"open", End::open}};

/// A ring whose first vertex is repeated at the end loses the repetition.
void open_ring(Vertices& ring) {
  if (ring.points.size() < 2 || !(ring.points.front() == ring.points.back())) return;
  ring.points.pop_back();
  if (!ring.lines.empty()) ring.lines.pop_back();
}

/// Faults of a ring or polyline that crosses itself.
bool check_simple(const Vertices& v, bool closed, Faults& faults) {
  const auto meeting = self_meeting(v.points, closed);
  if (!meeting) return true;
  const Vec2 from = v.points[meeting->second], to = v.points[(meeting->second + 1) % v.points.size()];
  faults.add(v.place(meeting->second), meeting->first == meeting->second
                                           ? "repeats the vertex before or after it, " + to_text(from)
                                           : "starts an edge, " + to_text(from) + " to " + to_text(to) +
                                                 ", that crosses or touches the edge from vertex " +
                                                 std::to_string(meeting->first) + ", " +
                                                 to_text(v.points[meeting->first]));
  return false;
}

/// Faults of a surface that does not run from left to right.
bool check_left_to_right(const Vertices& v, bool steps_allowed, Faults& faults) {
  for (std::size_t k = 1; k < v.points.size(); ++k) {
    const double before = v.points[k - 1].x, x = v.points[k].x;
    if (x > before || (steps_allowed && x == before)) continue;
    faults.add(v.place(k), "x = " + to_text(x) + " does not exceed the x before it, " + to_text(before) +
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

void read_outline(const Json& value, const std::string& pointer, const std::filesystem::path& directory,
                  const Json& material_json, SlideText& slide, Json& resolved, Faults& faults) {
  ObjectReader in(value, pointer, faults);
  Vertices outline = read_vertices(in, "outline", 3, directory);
  int material = 0;
  if (const Json* partial = in.find("material")) {
    ObjectReader own(*partial, in.pointer("material"), faults);
    material = index_of(read_material(own, &material_json), slide.materials);
    in.record("material", own.finish());
  }
  const bool sound = !outline.empty() && check_ring(outline, faults);
  in.record("outline_m", to_json(outline.points));
  resolved.push_back(in.finish());
  if (!sound) return;
  slide.parts.push_back({outline.points, material});
  slide.origins.push_back(std::move(outline));
}

void read_outlines(ObjectReader& in, const Json& list, const std::filesystem::path& directory,
                   const Json& material_json, SlideText& slide) {
  Json resolved = Json::array();
  if (!list.is_array() || list.empty() || list.size() > most_outlines)
    in.fault("outlines",
             (list.is_array() ? "has " + std::to_string(list.size()) + " entries" : quote(list) + " is no list") +
                 "; give 1 to " + std::to_string(most_outlines) + " outlines");
  else
    for (std::size_t k = 0; k < list.size(); ++k)
      read_outline(list[k], pointer_to(in.pointer("outlines"), k), directory, material_json, slide, resolved,
                   in.faults());
  in.record("outlines", resolved);
}

/// What a consultant has: the ground before the slide, and the surface it slides on.
void read_surfaces(ObjectReader& in, const std::filesystem::path& directory, SlideText& slide) {
  const Vertices ground = read_vertices(in, "ground_surface", 2, directory);
  const Vertices slip = read_vertices(in, "slip_surface", 2, directory);
  Json resolved = Json::array();
  if (!ground.empty() && !slip.empty() &&
      check_left_to_right(ground, true, in.faults()) & check_left_to_right(slip, true, in.faults())) {
    for (auto& outline : between_surfaces(ground.points, slip.points)) {
      resolved.push_back({{"outline_m", to_json(outline)}});
      slide.origins.push_back({outline, slip.source});
      slide.parts.push_back({std::move(outline), 0});
    }
    if (slide.parts.empty()) in.fault("", "holds no soil: the slip surface nowhere lies below the ground surface");
  }
  in.record("outlines", resolved);
}

/// Height of the end walls: given, or 5 particle spacings over the slide and over the walled ends of the bed.
double read_wall_top(ObjectReader& in, const Terrain& t, const SlideText& slide, double dx) {
  double highest = -1e6;
  for (const SlidePart& part : slide.parts)
    for (const Vec2& v : part.outline) highest = std::max(highest, v.y);
  const double left = t.left_wall && !t.bed.empty() ? t.bed.front().y : -1e6;
  const double right = t.right_wall && !t.bed.empty() ? t.bed.back().y : -1e6;
  const double top =
      in.number("wall_top_m", coordinate, std::clamp(std::max({highest, left, right}) + 5.0 * dx, -1e6, 1e6));
  if (top <= std::max(left, right) && in.faults().none_under(in.pointer("wall_top_m")))
    in.fault("wall_top_m",
             to_text(top) + " does not lie above the bed at the walled end, y = " + to_text(std::max(left, right)));
  return top;
}

void read_ends(ObjectReader& in, Terrain& t, const SlideText& slide, double dx) {
  if (t.closed) {
    for (const char* key : {"left_end", "right_end", "wall_top_m"})
      if (in.find(key) != nullptr) in.fault(key, "has no meaning for a closed bed");
    return;
  }
  t.left_wall = in.choice("left_end", ends, t.left_wall ? End::wall : End::open) == End::wall;
  t.right_wall = in.choice("right_end", ends, t.right_wall ? End::wall : End::open) == End::wall;
  t.wall_top = read_wall_top(in, t, slide, dx);
}

}  // namespace

SlideText read_slide(ObjectReader in, const std::filesystem::path& directory, const Material& material,
                     const Json& material_json, Json& resolved) {
  SlideText slide{{}, {}, {material}};
  const Json* outlines = in.find("outlines");
  bool surfaces = false;
  for (const char* key : {"ground_surface_m", "ground_surface_csv", "slip_surface_m", "slip_surface_csv"})
    surfaces = in.find(key) != nullptr || surfaces;
  if (outlines != nullptr && surfaces)
    in.fault("", "is given both by outlines and by surfaces; give one of the two");
  else if (outlines == nullptr && !surfaces)
    in.fault("outlines", "is missing (or ground_surface_m and slip_surface_m)");
  else if (outlines != nullptr)
    read_outlines(in, *outlines, directory, material_json, slide);
  else
    read_surfaces(in, directory, slide);
  resolved = in.finish();
  return slide;
}

Terrain read_terrain(ObjectReader in, const std::filesystem::path& directory, const SlideText& slide, double dx,
                     Vertices& bed, Json& resolved) {
  Terrain t;
  bed = read_vertices(in, "bed", 2, directory);
  t.closed = in.flag("closed", t.closed);
  const bool sound =
      !bed.empty() && (t.closed ? check_ring(bed, in.faults()) : check_left_to_right(bed, false, in.faults()));
  if (!sound) bed.points.clear();
  t.bed = bed.points;
  if (t.closed && signed_area(t.bed) < 0.0) std::reverse(t.bed.begin(), t.bed.end());
  in.record("bed_m", to_json(t.bed));
  double leftmost = sound ? t.bed.front().x : 0.0;
  for (const Vec2& v : t.bed) leftmost = std::min(leftmost, v.x);
  t.left_boundary = in.number("left_boundary_m", coordinate, leftmost);
  read_ends(in, t, slide, dx);
  resolved = in.finish();
  return t;
}

}  // namespace talus

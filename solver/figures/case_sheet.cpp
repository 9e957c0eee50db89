#include "figures/case_sheet.hpp"

#include <algorithm>
#include <array>

#include "figures/ground.hpp"
#include "figures/profile.hpp"
#include "simulation/particle_setup.hpp"

namespace talus::figures {
namespace {

constexpr std::array soils{slide_colour, "#9DB7C9", "#B5C99D", "#C9A0B4", "#D9CF8F", "#A9A9C9"};

const char* colour_of(int material) { return soils[static_cast<std::size_t>(material) % soils.size()]; }

Box view_of(const Model& model, const Polyline& fitted) {
  Box box = bounding_box(model.slide);
  for (const std::vector<Vec2>* line : {&model.terrain.bed, &fitted.vertices})
    for (const Vec2& v : *line) box.include(v);
  for (const Polyline& structure : structures_of(model))
    for (const Vec2& v : structure.vertices) box.include({v.x, std::max(v.y, box.lo.y)});
  const double margin = 0.03 * box.width() + model.dx;
  const double height = std::max(box.height(), 0.12 * box.width());
  return {{box.lo.x - margin, box.lo.y - 0.1 * height - 0.012 * box.width()},
          {box.hi.x + margin, box.lo.y + 1.12 * height}};
}

/// Plot elements of one figure, and their words in the key.
struct CaseDrawing {
  Sheet& sheet;
  std::vector<std::string> elements;

  void add(const std::string& element, std::string_view words = {}) {
    elements.push_back(element + (words.empty() ? "" : " title " + literal(words)));
  }
};

void draw_slide(CaseDrawing& d, const Model& model) {
  std::vector<int> named;
  for (std::size_t k = 0; k < model.slide.size(); ++k) {
    const SlidePart& part = model.slide[k];
    const bool first = std::ranges::find(named, part.material) == named.end();
    if (first) named.push_back(part.material);
    d.add(slide_element(d.sheet.script, "slide" + std::to_string(k), part.outline, colour_of(part.material)),
          first ? std::string_view(model.materials[static_cast<std::size_t>(part.material)].name) : "");
  }
}

void draw_walls(CaseDrawing& d, const Model& model) {
  std::vector<Vec2> points;
  for (const WallPoint& w : plan_particles(model).walls) points.push_back(w.x);
  d.sheet.script.data("walls", points);
  d.add("$walls using 1:2:(" + number(0.3 * model.dx) + ") with circles fillstyle solid noborder linecolor rgb '" +
            blue + "'",
        "wall particles");
}

/// A ring around the end of a bed that has no wall.
void mark_open_ends(CaseDrawing& d, const Terrain& terrain) {
  std::vector<Vec2> open;
  if (!terrain.closed && !terrain.left_wall) open.push_back(terrain.bed.front());
  if (!terrain.closed && !terrain.right_wall) open.push_back(terrain.bed.back());
  if (open.empty()) return;
  d.sheet.script.data("open", open);
  d.add(std::string("$open using 1:2 with points pointtype 6 pointsize 1.4 linewidth 2 linecolor rgb '") + vermillion +
            "'",
        "open end: soil may leave");
}

}  // namespace

Sheet case_sheet(const LoadedCase& loaded, const GroundReport& report, const Stamps& stamps, bool walls) {
  constexpr double key_row = 40;  // px above the panel
  const Model& model = loaded.value.model;
  const Polyline &given = model.boundaries.front().line, &fitted = report.fitted.line;
  const Box view = view_of(model, fitted);
  const Layout layout = profile_layout(1, view, key_row);
  const Panel& panel = layout.panels.front();
  Sheet sheet(layout.canvas, stamps);
  sheet.place(panel);
  sheet.axes(
      {view.lo.x, view.hi.x, nice_step(view.width(), panel.width(), 90), axis_label("x", model.terrain.origin.x)},
      {view.lo.y, view.hi.y, nice_step(view.height(), panel.height(), 32), ""});
  constexpr double label_column = 11;  // px from the left edge: beside the widest tic labels
  sheet.script("set label ", literal(axis_label("y", model.terrain.origin.y)), " at screen ",
               label_column / layout.canvas.width, ", screen ",
               1 - 0.5 * (panel.top + panel.bottom) / layout.canvas.height, " center rotate by 90");
  sheet.script("set key at screen ", panel.left / layout.canvas.width, ", screen ",
               1 - (panel.top - 0.5 * key_row) / layout.canvas.height,
               " left center horizontal Left reverse samplen 2 noautotitle font 'sans-serif,10' textcolor rgb '", ink,
               "'");
  CaseDrawing drawing{sheet, {}};
  const bool changed = !(given == fitted);
  const GroundElements bed = ground_elements(sheet.script, fitted, view, layout.metre, "", changed ? 1.2 : 2.2);
  for (const std::string& element : structure_elements(sheet.script, structures_of(model), "")) drawing.add(element);
  for (const std::string& element : bed.behind) drawing.add(element);
  draw_slide(drawing, model);
  if (walls) draw_walls(drawing, model);
  if (changed) {
    sheet.script.data("given", visible_part(given, view.lo.x, view.hi.x));
    drawing.add(line("given", vermillion, 3.0), "ground as given");
  }
  drawing.add(bed.front.front());
  drawing.add(bed.front.back(), changed ? "ground as fitted to the spacing" : "ground");
  mark_open_ends(drawing, model.terrain);
  sheet.script.plot(drawing.elements);
  return sheet;
}

}  // namespace talus::figures

#include "figures/case_sheet.hpp"

#include <algorithm>
#include <array>

#include "figures/ground.hpp"
#include "figures/profile.hpp"
#include "simulation/particle_setup.hpp"

namespace talus::figures {
namespace {

constexpr std::array soils{"#C9B79C", "#9DB7C9", "#B5C99D", "#C9A0B4", "#D9CF8F", "#A9A9C9"};

const char* colour_of(int material) { return soils[static_cast<std::size_t>(material) % soils.size()]; }

Box view_of(const Model& model, const Polyline& fitted) {
  Box box = bounding_box(model.slide);
  for (const std::vector<Vec2>* line : {&model.terrain.bed, &fitted.vertices})
    for (const Vec2& v : *line) box.include(v);
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

void draw_rock(CaseDrawing& d, const Polyline& fitted, const Box& view) {
  if (fitted.closed) return;
  std::vector<Vec2> rock = fitted.vertices;
  rock.insert(rock.end(), {{rock.back().x, view.lo.y}, {rock.front().x, view.lo.y}});
  d.sheet.script.data("rock", rock);
  d.add(std::string("$rock using 1:2 with filledcurves closed fillcolor rgb '") + ground + "'");
}

void draw_slide(CaseDrawing& d, const Model& model) {
  std::vector<int> named;
  for (std::size_t k = 0; k < model.slide.size(); ++k) {
    const SlidePart& part = model.slide[k];
    const std::string name = "slide" + std::to_string(k);
    d.sheet.script.data(name, part.outline);
    const bool first = std::ranges::find(named, part.material) == named.end();
    if (first) named.push_back(part.material);
    d.add("$" + name + " using 1:2 with filledcurves closed fillcolor rgb '" + colour_of(part.material) +
              "' fillstyle solid border rgb '#8A7556'",
          first ? std::string_view(model.materials[static_cast<std::size_t>(part.material)].name) : "");
  }
}

std::vector<Vec2> as_ring(const Polyline& line) {
  std::vector<Vec2> vertices = line.vertices;
  if (line.closed) vertices.push_back(vertices.front());
  return vertices;
}

void draw_ground(CaseDrawing& d, const Polyline& given, const Polyline& fitted, double metre) {
  std::vector<std::array<double, 4>> strokes;
  for (const Stroke& s : hatching(as_ring(fitted), 9 / metre, 8 / metre))
    strokes.push_back({s.from.x, s.from.y, s.along.x, s.along.y});
  d.sheet.script.data("hatch", strokes).data("fitted", as_ring(fitted));
  d.add(std::string("$hatch using 1:2:3:4 with vectors nohead linewidth 0.6 linecolor rgb '") + faint + "'");
  const bool changed = !(given == fitted);
  if (changed) {
    d.sheet.script.data("given", as_ring(given));
    d.add(line("given", vermillion, 3.0), "ground as given");
  }
  d.add(line("fitted", ink, changed ? 1.2 : 2.2), changed ? "ground as fitted to the spacing" : "ground");
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
  draw_rock(drawing, fitted, view);
  draw_slide(drawing, model);
  if (walls) draw_walls(drawing, model);
  draw_ground(drawing, given, fitted, layout.metre);
  mark_open_ends(drawing, model.terrain);
  sheet.script.plot(drawing.elements);
  return sheet;
}

}  // namespace talus::figures

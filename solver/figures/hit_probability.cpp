#include <algorithm>
#include <array>
#include <cmath>

#include "figures/charts.hpp"
#include "figures/ground.hpp"

namespace talus::figures {
namespace {

constexpr double width = 1040;
constexpr double left = 84;
constexpr double right = width - 28;
constexpr double curve_top = 84;
constexpr double curve_bottom = 304;
constexpr double gap = 16;       // px between curve and terrain
constexpr double tallest = 400;  // px, of the terrain
constexpr double beneath = 86;   // px: x tics, label, source line

Box view(const Quantity& q, const Terrain& terrain, std::span<const SlidePart> slide) {
  Box box{{terrain.left_boundary, 1e300}, {terrain.left_boundary, -1e300}};
  const auto include_y = [&box](double y) {
    box.lo.y = std::min(box.lo.y, y);
    box.hi.y = std::max(box.hi.y, y);
  };
  for (const SlidePart& part : slide) {
    for (const Vec2 p : part.outline) {
      box.lo.x = std::min(box.lo.x, p.x);
      box.hi.x = std::max(box.hi.x, p.x);
      include_y(p.y);
    }
  }
  for (const Exceedance& e : q.exceedance) box.hi.x = std::max(box.hi.x, terrain.left_boundary + e.x);
  const double margin = 0.03 * box.width();
  box.lo.x -= margin;
  box.hi.x += margin;
  for (const Vec2 p : boundary(terrain, box.lo.x, box.hi.x)) include_y(p.y);
  const double height = std::max(box.height(), 0.1 * box.width());
  box.lo.y -= 0.1 * height + 0.012 * box.width();
  box.hi.y = box.lo.y + 1.25 * height;
  return box;
}

// x, p, lo, hi from the left edge of the view to its right edge.
std::vector<std::array<double, 4>> curve(const Quantity& q, double boundary_x, const Box& box) {
  std::vector<std::array<double, 4>> rows;
  if (q.exceedance.empty()) return rows;
  const auto row = [](double x, const Exceedance& e) { return std::array{x, e.p, e.lo, e.hi}; };
  // Whoever runs farther than the first x reaches everything before it.
  rows.push_back(row(box.lo.x, q.exceedance.front()));
  for (const Exceedance& e : q.exceedance) rows.push_back(row(boundary_x + e.x, e));
  rows.push_back(row(box.hi.x, q.exceedance.back()));
  return rows;
}

std::string slide_elements(Script& script, std::span<const SlidePart> slide) {
  std::string elements;
  for (std::size_t i = 0; i < slide.size(); ++i) {
    const std::string name = "slide" + std::to_string(i);
    std::vector<Vec2> ring = slide[i].outline;
    ring.push_back(ring.front());
    script.data(name, ring);
    elements += "$" + name +
                " using 1:2 with filledcurves closed fillcolor rgb '#C9B79C' fillstyle solid border rgb '#8A7556', ";
  }
  return elements;
}

}  // namespace

Sheet hit_probability_sheet(const StudyFiles& study, const Terrain& terrain, std::span<const SlidePart> slide) {
  const Quantity& q = study.quantities.at("influence_zone_m");
  const Box box = view(q, terrain, slide);
  const double metre = std::min((right - left) / box.width(), tallest / box.height());
  const double terrain_bottom = curve_bottom + gap + metre * box.height();
  const Canvas canvas{std::round(left + metre * box.width() + 28), std::round(terrain_bottom + beneath)};
  Sheet sheet{
      begin(canvas,
            chart_stamps(study,
                         "Probability that the front reaches x, given failure (band: 95 %, Wilson); below: terrain "
                         "and slide before failure")),
      canvas};
  Script& script = sheet.script;
  const double edge = left + metre * box.width();
  script("set xrange [", box.lo.x, ":", box.hi.x, "]");
  script("set xtics ", nice_step(box.width(), std::max(2, static_cast<int>((edge - left) / 90))));

  script.data("curve", curve(q, terrain.left_boundary, box));
  script("set yrange [0:1.04]");
  script("set ytics 0.2");
  script("set format x ''");
  script("set ylabel 'probability'");
  place(script, canvas, {left, edge, curve_top, curve_bottom});
  script("plot $curve using 1:2 with filledcurves y1=0 fillcolor rgb '", blue,
         "' fillstyle transparent solid 0.12 noborder, \\");
  script("  $curve using 1:3:4 with filledcurves fillcolor rgb '", blue,
         "' fillstyle transparent solid 0.25 noborder, \\");
  script("  $curve using 1:2 with lines linewidth 2 linecolor rgb '", blue, "'");

  script("unset label");
  script("set format x '%g'");
  script("set yrange [", box.lo.y, ":", box.hi.y, "]");
  script("set ytics ", nice_step(box.height(), std::max(2, static_cast<int>(metre * box.height() / 50))));
  script("set xlabel 'x (m)'");
  script("set ylabel 'y (m)'");
  place(script, canvas, {left, edge, curve_bottom + gap, terrain_bottom});
  const GroundElements bed = ground_elements(script, terrain, box, metre, "");
  const std::string soil = slide_elements(script, slide);
  script("plot ", bed.behind, soil, bed.front, "NaN");
  return sheet;
}

}  // namespace talus::figures

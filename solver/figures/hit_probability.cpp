#include <algorithm>
#include <array>
#include <cmath>

#include "figures/charts.hpp"
#include "figures/ground.hpp"
#include "particles/geometry.hpp"

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

// The slide, the terrain, and what the runs reached.
Box view(const Quantity& q, const Terrain& terrain, std::span<const SlidePart> slide) {
  Box box{{terrain.run_out.from, 1e300}, {terrain.run_out.from, -1e300}};
  for (const SlidePart& part : slide)
    for (const Vec2 p : part.outline) box.include(p);
  for (const Exceedance& e : q.exceedance) {
    box.lo.x = std::min(box.lo.x, terrain.run_out.x(e.x));
    box.hi.x = std::max(box.hi.x, terrain.run_out.x(e.x));
  }
  const double margin = 0.03 * box.width();
  box.lo.x -= margin;
  box.hi.x += margin;
  for (const Vec2 p : visible_part(ground_line(terrain), box.lo.x, box.hi.x)) {
    box.lo.y = std::min(box.lo.y, p.y);
    box.hi.y = std::max(box.hi.y, p.y);
  }
  const double height = std::max(box.height(), 0.1 * box.width());
  box.lo.y -= 0.1 * height + 0.012 * box.width();
  box.hi.y = box.lo.y + 1.25 * height;
  return box;
}

// x, p, lo, hi from the uphill edge of the view to the other.
std::vector<std::array<double, 4>> curve(const Quantity& q, const RunOutAxis& axis, const Box& box) {
  std::vector<std::array<double, 4>> rows;
  if (q.exceedance.empty()) return rows;
  const auto row = [](double x, const Exceedance& e) { return std::array{x, e.p, e.lo, e.hi}; };
  const bool to_right = axis.to == SlidesTo::right;
  // A run that goes farther than the first x reaches everything before it.
  rows.push_back(row(to_right ? box.lo.x : box.hi.x, q.exceedance.front()));
  for (const Exceedance& e : q.exceedance) rows.push_back(row(axis.x(e.x), e));
  rows.push_back(row(to_right ? box.hi.x : box.lo.x, q.exceedance.back()));
  return rows;
}

}  // namespace

Sheet hit_probability_sheet(const StudyFiles& study, const Terrain& terrain, std::span<const SlidePart> slide) {
  const Quantity& q = study.runout();
  const Box box = view(q, terrain, slide);
  const double metre = std::min((right - left) / box.width(), tallest / box.height());
  const double edge = left + metre * box.width();
  const double terrain_bottom = curve_bottom + gap + metre * box.height();
  Sheet sheet = chart(
      study,
      std::string(
          "Probability that the farthest particle reaches x, given failure (band: 95 %, Wilson). Slide before it") +
          censored_text(q),
      {std::round(edge + 28), std::round(terrain_bottom + beneath)});
  Script& script = sheet.script;
  Axis x{box.lo.x, box.hi.x, nice_step(box.width(), edge - left, 90), ""};

  script.data("curve", curve(q, terrain.run_out, box));
  sheet.axes(x, {0, 1.04, 0.2, "probability"});
  script("set format x ''");
  sheet.place({left, edge, curve_top, curve_bottom});
  const std::string under_curve = std::string("$curve using 1:2 with filledcurves y1=0 fillcolor rgb '") + blue +
                                  "' fillstyle transparent solid 0.12 noborder";
  script.plot(std::array{under_curve, band("curve", "1:3:4", 0.25), line("curve", blue)});

  script("unset label");
  script("set format x '%g'");
  const std::string label = axis_label("x", terrain.origin.x);
  x.label = label;
  sheet.axes(
      x, {box.lo.y, box.hi.y, nice_step(box.height(), metre * box.height(), 50), axis_label("y", terrain.origin.y)});
  sheet.place({left, edge, curve_bottom + gap, terrain_bottom});
  const GroundElements bed = ground_elements(script, ground_line(terrain), box, metre, "");
  std::vector<std::string> elements = bed.behind;
  for (std::size_t i = 0; i < slide.size(); ++i)
    elements.push_back(slide_element(script, "slide" + std::to_string(i), slide[i].outline));
  elements.insert(elements.end(), bed.front.begin(), bed.front.end());
  script.plot(elements);
  return sheet;
}

}  // namespace talus::figures

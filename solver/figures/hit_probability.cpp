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
constexpr double title_bottom = 84;
constexpr double label_pitch = 16;  // px between the labels of targets
constexpr double curve_height = 220;
constexpr double gap = 16;       // px between curve and terrain
constexpr double tallest = 400;  // px, of the terrain
constexpr double beneath = 86;   // px: x tics, label, source line

constexpr std::size_t most_steps = 400;  // of the curve

// The edge of the slide on the side to which it goes, as a run-out.
double toe_of(const Terrain& terrain, std::span<const SlidePart> slide) {
  double toe = -1e300;
  for (const SlidePart& part : slide)
    for (const Vec2 p : part.outline) toe = std::max(toe, terrain.run_out.distance(p.x));
  return toe;
}

// The slide, the terrain, what the runs reached, some ground that none reached, and the targets.
Box view(const std::vector<double>& fronts, const Terrain& terrain, std::span<const SlidePart> slide,
         std::span<const Target> targets) {
  Box box{{terrain.run_out.from, 1e300}, {terrain.run_out.from, -1e300}};
  const auto show = [&](double x) {
    box.lo.x = std::min(box.lo.x, x);
    box.hi.x = std::max(box.hi.x, x);
  };
  for (const SlidePart& part : slide)
    for (const Vec2 p : part.outline) box.include(p);
  for (const double front : fronts) show(terrain.run_out.x(front));
  constexpr double unreached = 0.08;  // of the width so far
  if (!fronts.empty()) show(terrain.run_out.x(fronts.back() + unreached * box.width()));
  for (const Target& target : targets)
    for (const double x : {target.from, target.to}) show(x);
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

// x, p, lo, hi from the toe of the slide to the edge of the view: between two fronts nothing changes.
std::vector<std::array<double, 4>> curve(const StudyFiles& study, const std::vector<double>& fronts,
                                         const std::vector<double>& censored, const RunOutAxis& axis, double toe,
                                         const Box& box) {
  std::vector<double> steps{toe};
  const std::size_t every = std::max<std::size_t>(1, fronts.size() / most_steps);
  for (std::size_t k = 0; k < fronts.size(); k += every)
    if (fronts[k] > steps.back()) steps.push_back(fronts[k]);
  if (!fronts.empty() && fronts.back() > steps.back()) steps.push_back(fronts.back());
  const double edge = axis.distance(axis.to == SlidesTo::right ? box.hi.x : box.lo.x);
  std::vector<std::array<double, 4>> rows;
  const std::vector<Exceedance> at = exceedance(fronts, steps, study.failed, censored);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double end = k + 1 < at.size() ? at[k + 1].x : edge;
    for (const double s : {at[k].x, end}) rows.push_back({axis.x(s), at[k].p, at[k].lo, at[k].hi});
  }
  return rows;
}

// "house 0.21 [0.14, 0.30]"
std::string label_of(const StudyFiles& study, const Target& target) {
  const auto of = study.reached.find(target.of.name);
  if (of == study.reached.end()) return target.of.name;
  const Proportion& p = of->second;
  return target.of.name + " " + fixed(p.p, 2) + " [" + fixed(p.lo, 2) + ", " + fixed(p.hi, 2) + "]";
}

}  // namespace

Sheet hit_probability_sheet(const StudyFiles& study, const Terrain& terrain, std::span<const SlidePart> slide,
                            std::span<const Target> targets, const std::vector<Polyline>& structures) {
  const Quantity& q = study.runout();
  std::vector<double> fronts, censored;
  for (const Done& run : study.realizations) {
    fronts.push_back(run.influence_zone);
    if (run.lower_bound) censored.push_back(run.influence_zone);
  }
  std::ranges::sort(fronts);
  std::ranges::sort(censored);
  const Box box = view(fronts, terrain, slide, targets);
  const double metre = std::min((right - left) / box.width(), tallest / box.height());
  const double edge = left + metre * box.width();
  const double curve_top = title_bottom + label_pitch * static_cast<double>(targets.size());
  const double curve_bottom = curve_top + curve_height;
  const double terrain_bottom = curve_bottom + gap + metre * box.height();
  Sheet sheet =
      chart(study,
            std::string("Probability that the farthest particle reaches x, given failure (band: 95 %, Wilson)") +
                (targets.empty() ? ". Slide before it" : "; at names, that the flow arrives") + censored_text(q),
            {std::round(edge + 28), std::round(terrain_bottom + beneath)});
  Script& script = sheet.script;
  Axis x{box.lo.x, box.hi.x, nice_step(box.width(), edge - left, 90), ""};

  script.data("curve", curve(study, fronts, censored, terrain.run_out, toe_of(terrain, slide), box));
  sheet.axes(x, {0, 1.04, 0.2, "probability"});
  script("set format x ''");
  sheet.place({left, edge, curve_top, curve_bottom});
  const auto pixel = [&](double place) { return left + metre * (place - box.lo.x); };
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double middle =
        0.5 * (targets[k].from + (targets[k].structure ? targets[k].structure->foot.x : targets[k].to));
    const bool at_right = pixel(middle) > 0.5 * (left + edge);
    sheet.text(pixel(middle) + (at_right ? 4 : -4), title_bottom + label_pitch * (static_cast<double>(k) + 0.2),
               label_of(study, targets[k]), {.align = at_right ? Align::right : Align::left, .points = 9});
    if (targets[k].structure) continue;  // it is drawn itself
    for (const double place : {targets[k].from, targets[k].to})
      script("set arrow from ", place, ", graph 0 to ", place,
             ", graph 1 nohead dashtype 2 linewidth 0.8 linecolor rgb '", faint, "'");
  }
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
  std::vector<std::string> elements = structure_elements(script, structures, "");
  elements.insert(elements.end(), bed.behind.begin(), bed.behind.end());
  for (std::size_t i = 0; i < slide.size(); ++i)
    elements.push_back(slide_element(script, "slide" + std::to_string(i), slide[i].outline));
  elements.insert(elements.end(), bed.front.begin(), bed.front.end());
  script.plot(elements);
  return sheet;
}

}  // namespace talus::figures

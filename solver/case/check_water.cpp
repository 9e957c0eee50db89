// Whether a phreatic line fits the slide.

#include <algorithm>

#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// How high a line lies above the ground, and where [m].
struct Height {
  double above = 0.0;
  double x = 0.0;
};

double height_of(const std::vector<Vec2>& line, double x) {
  const auto right = std::ranges::lower_bound(line, x, {}, &Vec2::x);
  if (right == line.begin()) return line.front().y;
  return right == line.end() ? line.back().y : height_at(*std::prev(right), *right, x);
}

/// Both lines are straight between the vertices of either.
Height highest_above(const std::vector<Vec2>& line, const std::vector<SlidePart>& slide) {
  Height highest;
  const auto look_at = [&](double x) {
    const auto top = top_of(slide, x);
    if (top && height_of(line, x) - *top > highest.above) highest = {height_of(line, x) - *top, x};
  };
  for (const Vec2& v : line) look_at(v.x);
  for (const SlidePart& part : slide)
    for (const Vec2& v : part.outline) look_at(v.x);
  return highest;
}

}  // namespace

void check_water(const Model& model, const SourceLocations& origins, Faults& faults) {
  const std::vector<Vec2>& line = model.water.line;
  if (line.empty()) return;
  const Box slide = bounding_box(model.slide);
  if (line.front().x > slide.lo.x || line.back().x < slide.hi.x)
    faults.add(origins.water.source, "runs from x = " + to_text(line.front().x) + " to " + to_text(line.back().x) +
                                         "; it must cover the slide, x = " + to_text(slide.lo.x) + " to " +
                                         to_text(slide.hi.x));
  const Height highest = highest_above(line, model.slide);
  if (highest.above > 0.5 * model.dx)
    faults.add(origins.water.source, "lies " + rounded(highest.above) +
                                         " m above the ground at x = " + to_text(highest.x) +
                                         ": standing water is not modelled; half a particle spacing is tolerated. A "
                                         "pressure above the hydrostatic one is stated by r_u");
}

void warn_of_unused_water(const Model& model, std::vector<Fault>& warnings) {
  if (model.water.line.empty()) return;
  if (std::ranges::none_of(model.materials, [](const Material& m) { return !m.undrained && !m.r_u; }))
    warnings.push_back({"/water", "is not used: every material is undrained or states an r_u"});
}

}  // namespace talus

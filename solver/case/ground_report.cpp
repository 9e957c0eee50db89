#include "case/ground_report.hpp"

#include "case/outline.hpp"
#include "particles/geometry.hpp"

namespace talus {
namespace {

/// Greatest vertical thickness of all parts together, at evenly spaced x. [m]
double greatest_thickness(const Model& model, const Box& box) {
  constexpr int columns = 400;
  double greatest = 0.0;
  for (int k = 0; k < columns; ++k) {
    const Vec2 foot{box.lo.x + (k + 0.5) / columns * box.width(), box.lo.y};
    double sum = 0.0;
    for (const SlidePart& part : model.slide) sum += thickness_above(part.outline, foot);
    greatest = std::max(greatest, sum);
  }
  return greatest;
}

}  // namespace

GroundReport report_ground(const LoadedCase& loaded) {
  const Model& model = loaded.value.model;
  const Polyline& line = model.boundaries.front().line;
  const Box box = bounding_box(model.slide);
  const auto height = [&](double x) { return height_beneath(model.terrain.bed, {x, box.hi.y}); };
  GroundReport report{loaded.bed_source, model.terrain.bed.size(), 0, fit_line(line, model.dx), box};
  report.kept = report.fitted.line.vertices.size() - (line.vertices.size() - report.given);  // less the end walls
  report.thickness = greatest_thickness(model, box);
  report.goes_right = height(box.lo.x) >= height(box.hi.x);
  return report;
}

}  // namespace talus

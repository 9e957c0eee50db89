// National grids: coordinates of millions of metres for a slide of tens.

#include <algorithm>
#include <cmath>

#include "case/sections.hpp"
#include "particles/geometry.hpp"

namespace talus {
namespace {

constexpr double far_away = 10.0;   ///< distance of the slide from zero beyond which it counts as far, in extents
constexpr double resolution = 1e6;  ///< local coordinates are multiples of its inverse [1/m]

/// What is taken off one axis, to the micrometre; 0 where the slide is near zero.
double offset_of(double corner, double extent) {
  return std::abs(corner) > far_away * extent ? std::round(corner * resolution) / resolution : 0.0;
}

double local(double x, double offset) {
  return offset == 0.0 ? x : std::round((x - offset) * resolution) / resolution + 0.0;
}

void move(std::vector<Vec2>& vertices, Vec2 origin) {
  for (Vec2& v : vertices) v = {local(v.x, origin.x), local(v.y, origin.y)};
  // Vertices that rounding has made one.
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

}  // namespace

void use_local_coordinates(Case& c) {
  Model& m = c.model;
  const Box slide = bounding_box(m.slide);
  Box all = slide;
  for (const Vec2& v : m.terrain.bed) all.include(v);
  const double extent = std::max(all.width(), all.height());
  const Vec2 origin{offset_of(slide.lo.x, extent), offset_of(slide.lo.y, extent)};
  if (origin == Vec2{}) return;
  m.terrain.origin = origin;
  move(m.terrain.bed, origin);
  m.terrain.wall_top = local(m.terrain.wall_top, origin.y);
  for (std::optional<double>* top : {&m.terrain.left_top, &m.terrain.right_top})
    if (*top) *top = local(**top, origin.y);
  m.terrain.run_out.from = local(m.terrain.run_out.from, origin.x);
  for (Boundary& boundary : m.boundaries) {
    move(boundary.line.vertices, origin);
    for (WallStretch& stretch : boundary.stretches)
      for (double* end : {&stretch.x1, &stretch.x2}) *end = local(*end, origin.x);
  }
  move(m.water.line, origin);
  for (SlidePart& part : m.slide) move(part.outline, origin);
  if (c.field)
    for (FieldDatum& datum : c.field->data) datum.x = {local(datum.x.x, origin.x), local(datum.x.y, origin.y)};
  for (Target& target : m.targets) {
    target.from = local(target.from, origin.x);
    target.to = local(target.to, origin.x);
    if (target.structure)
      target.structure->foot = {local(target.structure->foot.x, origin.x), local(target.structure->foot.y, origin.y)};
  }
  if (c.field && c.field->domain) {
    Box& domain = *c.field->domain;
    domain = {{local(domain.lo.x, origin.x), local(domain.lo.y, origin.y)},
              {local(domain.hi.x, origin.x), local(domain.hi.y, origin.y)}};
  }
}

}  // namespace talus

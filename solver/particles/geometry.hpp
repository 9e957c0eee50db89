#pragma once
// From outlines to points: area, depth of burial, the lattice that fills a slide, and the distance to a polyline.

#include <span>
#include <vector>

#include "material/material.hpp"
#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"

namespace talus {

/// Area inside a closed outline [m2], either orientation.
double area(std::span<const Vec2> outline);

/// Smallest box around all outlines [m].
Box bounding_box(std::span<const SlidePart> slide);

/// Length of the vertical line above `point` that lies inside the outline [m].
double cover(std::span<const Vec2> outline, Vec2 point);

/// Mass of soil above a point per area of ground, sum of rho0 * cover [kg/m2].
double overburden(std::span<const SlidePart> slide, std::span<const Material> materials, Vec2 point);

/// A polyline with soil on its left side as it is walked, rock on its right.
struct Polyline {
  std::vector<Vec2> vertices;  ///< [m], at least 2; closed: the first is not repeated
  bool closed = false;

  std::size_t segments() const { return closed ? vertices.size() : vertices.size() - 1; }
  Vec2 start(std::size_t s) const { return vertices[s]; }
  Vec2 end(std::size_t s) const { return vertices[s + 1 == vertices.size() ? 0 : s + 1]; }
  double length() const;
  /// Point at arc length s from the first vertex [m].
  Vec2 at(double s) const;
};

/// Where a point stands relative to a polyline.
struct Foot {
  Vec2 point;       ///< nearest point of the polyline [m]
  double distance;  ///< [m], positive on the soil's side
};
Foot nearest(const Polyline& line, Vec2 point);

/// The polyline moved by `offset` towards the rock (mitred corners).
Polyline offset_into_rock(const Polyline& line, double offset);

/// The line that no particle may cross: the bed with its end walls; for Placement::nodes half a spacing behind it.
Polyline wall_line(const Terrain& terrain, double dx, Placement placement);

/// A soil particle to be.
struct SoilPoint {
  Vec2 x;        ///< [m]
  int material;  ///< index into Model::materials
};

/// Fills the outlines with a square lattice of spacing dx, row by row from the bottom left.
/// Points nearer than dx/2 to the wall line are left out: they would start compressed against the wall.
std::vector<SoilPoint> fill_slide(std::span<const SlidePart> slide, const Terrain& terrain, double dx,
                                  Placement placement);

}  // namespace talus

#pragma once
// From outlines to points: area, depth of burial, distance to a polyline, the lattice that fills a slide, and the rows
// of particles that line a wall.

#include <cstdint>
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

/// Thickness of the soil above `point`: the length of the vertical line that lies inside the outline [m].
double thickness_above(std::span<const Vec2> outline, Vec2 point);

/// Mass of soil above a point per area of ground, sum of rho0 * thickness [kg/m2].
double mass_above(std::span<const SlidePart> slide, std::span<const Material> materials, Vec2 point);

/// The projection of a point onto a polyline.
struct Projection {
  Vec2 point;       ///< nearest point of the polyline [m]
  double distance;  ///< [m], positive on the soil's side
};
Projection project(Vec2 point, const Polyline& line);

/// Distance of a point to the nearest of several lines, at least one [m]; positive on the soil's side.
double signed_distance(Vec2 point, std::span<const Polyline> lines);

/// The polyline moved by `offset` towards the rock (mitred corners).
Polyline offset_into_rock(const Polyline& line, double offset);

/// The line of the ground: the bed with its end walls.
Polyline ground_line(const Terrain& terrain);

/// The lines that no particle may cross, one for each boundary: its own line; for Placement::nodes half a spacing
/// behind it.
std::vector<Polyline> wall_lines(std::span<const Boundary> boundaries, double dx, Placement placement);

/// A soil particle to be.
struct SoilPoint {
  Vec2 x;        ///< [m]
  int material;  ///< index into Model::materials
};

/// Fills the outlines with a square lattice of spacing dx, row by row from the bottom left.
/// Points nearer than dx/2 to a wall line are left out: they would start compressed against the wall.
/// @param walls  as wall_lines() returns them
std::vector<SoilPoint> fill_slide(std::span<const SlidePart> slide, std::span<const Polyline> walls, double dx,
                                  Placement placement);

/// A wall particle: where it stands and the piece of wall it stands behind. Fixed particles fill the rock behind the
/// wall line, [Z20] 2.1 and method of Takeda 1994, Morris 1997.
struct WallPoint {
  Vec2 x;                 ///< [m]
  Vec2 n;                 ///< unit normal of the wall there, towards the soil
  double depth;           ///< distance to the wall line [m], > 0
  std::int32_t boundary;  ///< index into Model::boundaries
};

/// Lines the wall with `layers` rows of particles at depths (k + 1/2) dx, spaced dx along each row.
/// @param boundary  index that the points are given
std::vector<WallPoint> fill_walls(const Polyline& wall, double dx, int layers, std::int32_t boundary = 0);

}  // namespace talus

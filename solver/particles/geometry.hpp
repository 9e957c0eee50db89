#pragma once
// From outlines to points: area, depth of burial, walls as lines, and the rows of particles that line them.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "material/material.hpp"
#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"

namespace talus {

/// Area inside a closed outline [m2], positive when it is walked counter-clockwise.
double signed_area(std::span<const Vec2> outline);
/// Area inside a closed outline [m2], either orientation.
double area(std::span<const Vec2> outline);

/// Height at x of the line through a and b, which is not vertical [m].
double height_at(Vec2 a, Vec2 b, double x);

/// Smallest box around all outlines [m].
Box bounding_box(std::span<const SlidePart> slide);

/// Thickness of the soil above `point`: the length of the vertical line that lies inside the outline [m].
double thickness_above(std::span<const Vec2> outline, Vec2 point);

/// Height of the highest soil at x, that of the ground surface before the slide [m]; unset: no outline has soil there.
std::optional<double> top_of(std::span<const SlidePart> slide, double x);

/// Depth of a point below the highest outline above or below it [m], >= 0; 0 beside the outlines.
double depth_below_surface(std::span<const SlidePart> slide, Vec2 point);

/// The greatest depth of a point of the outlines [m].
double greatest_depth(std::span<const SlidePart> slide);

/// The material of the first outline that a point lies in, or 0.
int material_at(std::span<const SlidePart> slide, Vec2 point);

/// Mass of soil above a point per area of ground, sum of rho0 * thickness [kg/m2].
double mass_above(std::span<const SlidePart> slide, std::span<const Material> materials, Vec2 point);

/// Mass of the soil in the outlines per metre of width, sum of rho0 * area [kg/m].
double mass_of(std::span<const SlidePart> slide, std::span<const Material> materials);

/// The polyline moved by `offset` towards the rock (mitred corners).
Polyline offset_into_rock(const Polyline& line, double offset);

/// The line of the ground: the bed with its end walls.
Polyline ground_line(const Terrain& terrain);

/// The lines that no particle may cross, one for each boundary: its own, fitted to the spacing (fit_line); for
/// Placement::nodes half a spacing behind it.
std::vector<Polyline> wall_lines(std::span<const Boundary> boundaries, double dx, Placement placement);

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

#pragma once
// From outlines to soil particles: the cells of a square lattice, cut at the outlines.

#include <span>
#include <vector>

#include "math/vec2.hpp"
#include "particles/geometry_input.hpp"

namespace talus {

/// A soil particle to be.
struct SoilPoint {
  Vec2 x;              ///< [m]
  int material;        ///< index into Model::materials
  double cells = 1.0;  ///< area that it stands for [dx2], > 0
};

/// Least area that a particle of Placement::cells stands for, unless its whole outline is smaller [dx2].
constexpr double least_cells = 0.5;
/// Least distance from a wall line at which a particle of Placement::cells starts, out of reach of GroundContact [dx].
constexpr double least_distance = 0.2;

/// Fills the outlines with soil particles, row by row of a lattice of spacing dx that begins at the lower left corner
/// of their bounding box; for a slide that goes to the left at the lower right one, so that mirrored slides are filled
/// alike.
/// - Placement::cells: one particle at the centroid of each cell, cut at the outline; pieces smaller than least_cells
///   join the piece of their outline with which they share the longest edge. The areas add up to that of the outlines.
///   Centroids nearer to a wall line than least_distance are moved away from it.
/// - Placement::whole_cells, Placement::nodes: one particle for each lattice point in an outline, less those nearer
///   than dx/2 to a wall line; each stands for a whole cell.
/// @param walls  as wall_lines() returns them, at least one
/// @param dx     particle spacing [m], > 0
/// @param lattice  shift and angle of the lattice, with Placement::cells
std::vector<SoilPoint> fill_slide(std::span<const SlidePart> slide, std::span<const Polyline> walls, double dx,
                                  Placement placement, SlidesTo slides_to = SlidesTo::right,
                                  const Lattice& lattice = {});

}  // namespace talus

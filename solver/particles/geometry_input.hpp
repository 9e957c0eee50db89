#pragma once
// The shape of the problem as a person describes it: terrain, boundaries and slide.

#include <optional>
#include <string>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

enum class SlidesTo { right, left };

/// How run-outs are measured: along x, in the direction of the slide.
struct RunOutAxis {
  double from = 0.0;  ///< x where they begin [m]
  SlidesTo to = SlidesTo::right;

  double distance(double x) const { return to == SlidesTo::right ? x - from : from - x; }
  double x(double distance) const { return to == SlidesTo::right ? from + distance : from - distance; }
  bool operator==(const RunOutAxis&) const = default;
};

/// The rigid ground. An open bed runs from its left end to its right end, with the soil on its left as it is walked: it
/// may have vertical faces and overhangs. A closed one is a ring that is walked counter-clockwise and holds the soil
/// inside.
struct Terrain {
  std::vector<Vec2> bed;    ///< vertices [m]; open: least x first, greatest last; closed: first not repeated at the end
  bool closed = false;      ///< the bed is a ring
  bool left_wall = true;    ///< a vertical wall stands on the first bed vertex
  bool right_wall = false;  ///< a vertical wall stands on the last bed vertex
  double wall_top = 0.0;    ///< y of the top of an end wall without a top of its own [m]
  RunOutAxis run_out;
  double front_thickness = 0.1;  ///< of the soil at the front at fixed thickness [m], > 0
  Vec2 origin = {};  ///< what was taken off the coordinates of the case; what is published has it added again [m]
  std::optional<double> left_top = {};   ///< y of the top of the left end wall; unset: wall_top [m]
  std::optional<double> right_top = {};  ///< y of the top of the right end wall; unset: wall_top [m]

  double left_wall_top() const { return left_top.value_or(wall_top); }
  double right_wall_top() const { return right_top.value_or(wall_top); }
  bool operator==(const Terrain&) const = default;
};

/// What the front at fixed thickness takes where the case gives none: 0.1 m, or half-way between one row of particles
/// and two, so that a single row, which the method does not resolve, never makes a front. [m]
/// @param dx  particle spacing [m]
constexpr double default_front_thickness(double dx) { return dx > 0.1 / 1.5 ? 1.5 * dx : 0.1; }

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
  bool operator==(const Polyline&) const = default;
};

enum class WallSlip { no_slip, friction, free_slip };  ///< friction: the soil's own, or a smaller angle of the wall

/// A part of a boundary with a friction of its own, between two vertical lines.
struct WallStretch {
  double x1 = 0.0, x2 = 0.0;      ///< from x1 to x2 [m], x1 < x2
  double phi = 0.0;               ///< friction angle [rad], in [0, pi/2)
  std::optional<double> c = {};   ///< cohesion [Pa], >= 0; unset: the soil's
  std::optional<double> xi = {};  ///< turbulence coefficient of Voellmy's law [m/s2], > 0; unset: none
  bool operator==(const WallStretch&) const = default;
};

/// A rigid boundary of the flow.
struct Boundary {
  std::string name = "bed";
  Polyline line;
  WallSlip slip = WallSlip::no_slip;
  double phi = 0.0;               ///< friction angle of the wall, used with WallSlip::friction [rad], in [0, pi/2)
  std::optional<double> c = {};   ///< cohesion of the wall, used with WallSlip::friction [Pa], >= 0; unset: the soil's
  std::optional<double> xi = {};  ///< of Voellmy's law, used with WallSlip::friction [m/s2], > 0; unset: none
  std::vector<WallStretch> stretches = {};  ///< that do not overlap
  bool operator==(const Boundary&) const = default;
};

/// A closed outline of soil of one material. Outlines of one slide do not overlap.
struct SlidePart {
  std::vector<Vec2> outline;  ///< vertices [m], first vertex not repeated at the end, either orientation
  int material = 0;           ///< index into Model::materials
  bool operator==(const SlidePart&) const = default;
};

/// Where the particles stand relative to the outlines.
enum class Placement {
  cells,        ///< centroids of square cells, cut at the outlines: the particles carry the mass of the outlines
  whole_cells,  ///< centres of square cells that lie in an outline: a particle stays spacing/2 away from the wall
  nodes,  ///< nodes of the lattice, edges included, as in [Z20] Fig. 3: the wall line lies spacing/2 behind the bed
};

/// How the square lattice of Placement::cells lies: by default along x and y from the lower left corner of the slide's
/// bounding box. In a slide that goes to the left it is mirrored.
struct Lattice {
  Vec2 shift;          ///< of the corner, along the lattice's own axes [dx]
  double angle = 0.0;  ///< by which it is turned about that corner, counter-clockwise [rad]
  bool operator==(const Lattice&) const = default;
};

}  // namespace talus

#pragma once
// Everything that a deterministic run needs to know.

#include <optional>
#include <vector>

#include "material/material.hpp"
#include "particles/geometry_input.hpp"
#include "simulation/target.hpp"
#include "sph/numerics.hpp"

namespace talus {

/// When the run counts as come to rest.
struct StopAtRest {
  double speed = 0.01;  ///< root-mean-square speed below which the slide rests [m/s], > 0
  double hold = 0.5;    ///< for how long it must stay below [s], >= 0
  bool operator==(const StopAtRest&) const = default;
};

/// When to stop and what to keep.
struct TimeControl {
  double end = 10.0;                 ///< [s], > 0
  std::optional<double> fixed_step;  ///< constant time step [s]; unset: from the Courant number
  std::optional<double> max_step;    ///< upper bound of the Courant step [s]
  std::vector<double> snapshots;     ///< times [s], increasing, in [0, end]; start and end are always kept
  bool snapshots_exact = false;      ///< shorten steps to end at these times
  std::optional<StopAtRest> stop_at_rest;
  bool operator==(const TimeControl&) const = default;
};

enum class PoreWater { carried };  ///< each particle keeps its ratio of pore pressure to total stress

/// Water in the soil before the slide.
struct Water {
  std::vector<Vec2> line;   ///< phreatic line [m], x increasing; empty: none
  double density = 1000.0;  ///< of the water [kg/m3], > 0
  PoreWater in_motion = PoreWater::carried;
  bool operator==(const Water&) const = default;
};

/// A deterministic problem in SI units and radians. `case/` makes it from JSON.
struct Model {
  Terrain terrain;                   ///< what is measured from and drawn; the flow sees the boundaries
  std::vector<Boundary> boundaries;  ///< at least one: the ground_line() of the terrain; then structures
  std::vector<SlidePart> slide;
  std::vector<Material> materials;  ///< at least one
  Water water;
  double left_out = 0.0;  ///< mass of films that the outlines held, too thin for particles [kg/m]
  double dx = 0.1;        ///< particle spacing [m], > 0
  Placement placement = Placement::cells;
  Lattice lattice = {};  ///< with Placement::cells
  Vec2 g{0.0, -9.81};    ///< gravity [m/s2]
  Rheology rheology;
  Numerics numerics;
  Walls walls;
  TimeControl time;
  std::size_t max_particles = 4'000'000;  ///< refuse to fill more than this
  std::vector<Target> targets = {};       ///< places to observe, and structures, each of which has a boundary
  bool operator==(const Model&) const = default;
};

}  // namespace talus

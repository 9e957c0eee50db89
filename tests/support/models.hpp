#pragma once
// Small models for tests.

#include <utility>

#include "math/angle.hpp"
#include "particles/geometry.hpp"
#include "simulation/model.hpp"

namespace talus::testing_support {

constexpr double degree = radians(1.0);

/// The ground of a model, its only boundary.
inline void set_ground(Model& m, Terrain terrain) {
  m.terrain = std::move(terrain);
  m.boundaries = {{.line = ground_line(m.terrain)}};
}

/// A box of soil, width x height, between two walls, filled to the brim from a flat bed.
inline Model column(double width, double height, double dx, double phi_deg = 25.0) {
  Model m;
  set_ground(m, {{{0, 0}, {width, 0}}, false, true, true, 1.5 * height, 0.0});
  m.slide = {{{{0, 0}, {width, 0}, {width, height}, {0, height}}, 0}};
  m.materials = {{"soil", 2000, phi_deg * degree, 0, 0}};
  m.dx = dx;
  m.time.end = 1.0;
  return m;
}

/// A column that collapses to the right over a flat open bed.
inline Model collapse(double dx) {
  Model m = column(1.0, 0.8, dx);
  set_ground(m, {{{0, 0}, {5, 0}}, false, true, false, 1.2, 0.0});
  return m;
}

}  // namespace talus::testing_support

#pragma once
// Slides whose energy is followed to the end.

#include "models.hpp"
#include "simulation/simulation.hpp"

namespace talus::testing_support {

/// A slope of 30 degrees between a wall and an open end, 770 particles at a spacing of 0.4 m.
inline Model slope(double dx = 0.4) {
  Model m;
  set_ground(m, {{{0, 8.2}, {14.202, 0}, {60, 0}}, false, true, false, 14.2, 0.0});
  m.slide = {{{{0, 8.2}, {14.202, 0}, {21.325, 0}, {9.125, 12.2}, {0, 12.2}}, 0}};
  m.materials = {{"soil", 2200, 25 * degree, 0, 0}};
  m.dx = dx;
  m.time.end = 9.0;
  return m;
}

/// A block that slides over a cliff of 10 m: soil that comes apart and falls.
inline Model cliff(double dx = 0.5) {
  Model m;
  set_ground(m, {{{0, 10}, {10, 10}, {10.001, 0}, {40, 0}}, false, true, false, 16.5, 0.0});
  m.slide = {{{{0, 10}, {8, 10}, {8, 14}, {0, 14}}, 0}};
  m.materials = {{"soil", 2000, 25 * degree, 0, 0}};
  m.dx = dx;
  m.time.end = 10.0;
  return m;
}

/// The largest created energy of a run, over the work of gravity at its end; with the sign of the former.
inline double created_share(const Model& m) {
  Simulation simulation(m, plan_particles(m));
  double created = 0.0;
  while (!simulation.finished()) {
    simulation.step(m.time.end);
    if (simulation.steps() % 50 != 0 && !simulation.finished()) continue;
    const double now = simulation.energy().created();
    if (std::abs(now) > std::abs(created)) created = now;
  }
  return created / simulation.energy().gravity_work();
}

}  // namespace talus::testing_support

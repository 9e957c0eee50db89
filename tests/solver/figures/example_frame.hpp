#pragma once
// A frame whose every number differs.

#include <cmath>

#include "math/angle.hpp"
#include "simulation/frame.hpp"

namespace talus::test {

// Soil of three particles and a wall particle that must not be drawn.
inline Frame three_particles() {
  Frame frame;
  frame.time = 2.25;
  frame.n_soil = 3;
  frame.position = {{2, 9}, {20, 0.5}, {5, 6}, {99, 99}};
  frame.displacement = {{0, 0}, {3, 4}, {0, 1}, {0, 0}};
  frame.velocity = {{1, 0}, {0.6, -0.8}, {0, 7}, {0, 0}};
  frame.pressure = {1000, 0, 25000, 1e9};
  frame.tan_phi = {std::tan(radians(20)), std::tan(radians(25)), std::tan(radians(30)), 0};
  return frame;
}

}  // namespace talus::test

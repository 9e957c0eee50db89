#pragma once
// Long slabs of soil on a plane: their middle moves as the infinite slope does.

#include <cmath>
#include <utility>

#include "models.hpp"
#include "simulation/simulation.hpp"

namespace talus::testing_support {

inline constexpr double standard_gravity = 9.81;

/// A slab of a length and a normal thickness [m] on a plane that falls to the right by `theta` [rad], its lower left
/// corner at the origin.
struct Slab {
  double theta, length, thickness, dx;

  Vec2 at(double distance, double height) const {
    return {distance * std::cos(theta) + height * std::sin(theta),
            height * std::cos(theta) - distance * std::sin(theta)};
  }
  /// Without a material; the plane goes on below for `run_out` [m].
  Model model(double run_out) const {
    Model m;
    set_ground(m, {{at(-6 * dx, 0), at(length + run_out, 0)}, false, false, false, 0, 0});
    m.slide = {{{at(0, 0), at(length, 0), at(length, thickness), at(0, thickness)}, 0}};
    m.dx = dx;
    m.numerics.c_s = 60.0;
    m.numerics.integrator = Integrator::leapfrog;
    return m;
  }
  /// Vertical thickness [m].
  double depth() const { return thickness / std::cos(theta); }
  /// Whether a point started in the middle fifth.
  bool in_the_middle(Vec2 start) const {
    const double distance = start.x * std::cos(theta) - start.y * std::sin(theta);
    return std::abs(distance - 0.5 * length) < 0.1 * length;
  }
};

/// What the middle of a slab does.
struct Motion {
  double speed = 0.0;     ///< down the plane [m/s]
  double distance = 0.0;  ///< the same [m]
};

/// Of a running simulation, of the particles that started in the middle.
inline Motion motion(const Slab& slab, const Simulation& simulation) {
  const Frame f = simulation.frame();
  Motion mean;
  double n = 0.0;
  for (std::size_t i = 0; i < f.n_soil; ++i) {
    if (!slab.in_the_middle(f.position[i] - f.displacement[i])) continue;
    const Vec2 down{std::cos(slab.theta), -std::sin(slab.theta)};
    mean.speed += dot(f.velocity[i], down);
    mean.distance += dot(f.displacement[i], down);
    n += 1.0;
  }
  return {mean.speed / n, mean.distance / n};
}

/// Acceleration in the second half of `seconds`: at first the slab falls almost freely, until its elastic shear stress
/// has reached the yield limit. [m/s2]
inline double late_acceleration(const Slab& slab, Model m, double seconds) {
  m.time.end = seconds;
  Simulation simulation(m, plan_particles(m));
  while (simulation.time() < 0.5 * seconds) simulation.step(0.5 * seconds);
  const double middle = motion(slab, simulation).speed;
  while (!simulation.finished()) simulation.step(seconds);
  return (motion(slab, simulation).speed - middle) / (0.5 * seconds);
}

/// Resistance over weight along the plane, sin(theta) - a/g [-].
inline double resistance(const Slab& slab, double acceleration) {
  return std::sin(slab.theta) - acceleration / standard_gravity;
}

}  // namespace talus::testing_support

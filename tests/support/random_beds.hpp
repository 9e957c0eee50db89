#pragma once
// Slides over beds of cliffs, ledges, notches, V corners and thin walls, as chance has it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "models.hpp"
#include "simulation/simulation.hpp"
#include "support/error.hpp"

namespace talus::testing_support {

/// Depth of a point below an open bed [m]: by the parity of crossings, independent of the solver's own distance.
inline double depth_below(const Polyline& bed, Vec2 p) {
  bool below = true;  // far above every line the number of crossings below the point is odd
  double nearest2 = 1e300;
  for (std::size_t s = 0; s < bed.segments(); ++s) {
    const Vec2 a = bed.start(s), b = bed.end(s);
    if ((a.x <= p.x) != (b.x <= p.x) && a.y + (p.x - a.x) * (b.y - a.y) / (b.x - a.x) <= p.y) below = !below;
    const double t = std::clamp(dot(p - a, b - a) / norm2(b - a), 0.0, 1.0);
    nearest2 = std::min(nearest2, norm2(p - a - t * (b - a)));
  }
  return below ? std::sqrt(nearest2) : -std::sqrt(nearest2);
}

/// A bed of cliffs, ledges, notches, V corners and thin walls, as chance has it; it falls by some 20 m over 40 m.
/// @param overhangs  faces that lean over the foot are among them
inline Polyline random_bed(std::mt19937& random, bool overhangs = false) {
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
  Polyline bed{{{0, 20}, {8, 20}}, false};
  double x = 8, y = 20;
  while (x < 34) {
    switch (std::uniform_int_distribution<int>(0, overhangs ? 6 : 5)(random)) {
      case 0: {  // cliff
        y -= uniform(1, 8);
        bed.vertices.push_back({x += 0.001, y});
        break;
      }
      case 1: {  // notch or V
        const double depth = uniform(0.5, 4), width = uniform(0.2, 3);
        bed.vertices.push_back({x += 0.5 * width, y - depth});
        bed.vertices.push_back({x += 0.5 * width, y});
        break;
      }
      case 2: {  // thin wall
        const double height = uniform(0.5, 3), width = uniform(0.3, 1);
        bed.vertices.push_back({x += 0.001, y + height});
        bed.vertices.push_back({x += width, y + height});
        bed.vertices.push_back({x += 0.001, y});
        break;
      }
      case 3: {  // ledge that rises
        bed.vertices.push_back({x += uniform(1, 4), y += uniform(0, 0.6)});
        break;
      }
      case 6: {  // overhang: back under the crest, then down a vertical face
        const double height = uniform(1, 5), back = uniform(0.2, 1.5);
        const Vec2 crest = bed.vertices.back();
        if (crest.x - bed.vertices[bed.vertices.size() - 2].x < back + 1.0) break;  // too thin a crest
        bed.vertices.push_back({x -= back, y -= 0.5 * height});
        bed.vertices.push_back({x, y -= 0.5 * height});
        break;
      }
      default: {  // slope
        const double run = uniform(1, 8);
        y -= run * uniform(0, 1.2);
        bed.vertices.push_back({x += run, y});
      }
    }
    bed.vertices.push_back({x += uniform(0.3, 3), y});
  }
  bed.vertices.push_back({x + 20, y});
  return bed;
}

struct RandomBeds {
  double deepest = -1e300;  ///< that any particle was in the ground at any step [dx]
  int diverged = 0;         ///< runs
};

/// Lets a block fall onto random beds and slide; every fourth bed has free slip.
inline RandomBeds slide_over_random_beds(int from, int to, bool overhangs = false) {
  RandomBeds seen;
  for (int seed = from; seed < to; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const Polyline bed = random_bed(random, overhangs);
    Model m;
    set_ground(m, {bed.vertices, false, true, false, 30, 0});
    m.slide = {{{{1, 20}, {7, 20}, {7, 24}, {1, 24}}, 0}};
    m.materials = {{"soil", 2000, std::uniform_real_distribution<double>(5, 35)(random) * degree, 0, 0}};
    m.dx = 0.5;
    m.numerics.c_s = 60;
    m.numerics.integrator = Integrator::leapfrog;
    m.numerics.cfl = 0.3;
    if (seed % 4 == 1) m.boundaries[0].slip = WallSlip::free_slip;
    m.time.end = 6.0;
    const ParticlePlan plan = plan_particles(m);
    Simulation simulation(m, plan, material_properties(m, plan));
    double deepest = -1e300;
    try {
      while (!simulation.finished()) {
        simulation.step(m.time.end);
        if (simulation.steps() % 10 != 0) continue;
        for (std::size_t i = 0; i < simulation.soil().n_active; ++i)
          deepest = std::max(deepest, depth_below(bed, simulation.soil().position(i)) / m.dx);
      }
    } catch (const DivergedError&) {
      ++seen.diverged;
    }
    EXPECT_EQ(simulation.result().penetrated, 0) << "bed " << seed;
    EXPECT_LT(deepest, 1e-6) << "bed " << seed;
    seen.deepest = std::max(seen.deepest, deepest);
  }
  return seen;
}

}  // namespace talus::testing_support

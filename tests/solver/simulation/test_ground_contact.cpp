// Soil never passes the ground, whatever its shape.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "models.hpp"
#include "simulation/observables.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

using namespace testing_support;

Soil particle(Vec2 x, Vec2 v, double tan_phi) {
  Soil soil;
  for_each_state(soil, [](const char*, auto& array) { array.assign(1, 1.0); });
  soil.x[0] = x.x;
  soil.y[0] = x.y;
  soil.vx[0] = v.x;
  soil.vy[0] = v.y;
  soil.tan_phi[0] = tan_phi;
  soil.id = {0};
  soil.material = {0};
  soil.n_active = 1;
  return soil;
}

GroundContact contact_with(Polyline line, WallFriction friction = {}) {
  return {{std::move(line)}, {friction}, 1.0, 1};
}
const Polyline flat{{{-100, 0}, {100, 0}}, false};

TEST(GroundContact, TakesTheApproachAndFrictionsShareOfTheSliding) {
  Soil soil = particle({0, 0.02}, {5, -2}, 0.5);
  GroundContact contact = contact_with(flat);
  EXPECT_DOUBLE_EQ(contact.act(soil, 0.1), 0.08);
  EXPECT_DOUBLE_EQ(soil.y[0], 0.1);
  EXPECT_DOUBLE_EQ(soil.vy[0], 0.0);
  EXPECT_DOUBLE_EQ(soil.vx[0], 5 - 0.5 * 2);
}

TEST(GroundContact, FrictionStopsButDoesNotTurnBack) {
  Soil soil = particle({0, -0.02}, {0.3, -2}, 0.5);
  contact_with(flat).act(soil, 0.1);
  EXPECT_EQ(soil.vx[0], 0.0);
}

TEST(GroundContact, TheBoundarysFrictionCounts) {
  Soil smooth = particle({0, 0}, {5, -2}, 0.5), rougher = smooth, free = smooth;
  contact_with(flat, {WallSlip::friction, 0.1}).act(smooth, 0.1);
  contact_with(flat, {WallSlip::friction, 0.7}).act(rougher, 0.1);
  contact_with(flat, {WallSlip::free_slip, 0.7}).act(free, 0.1);
  EXPECT_DOUBLE_EQ(smooth.vx[0], 5 - 0.1 * 2);
  EXPECT_DOUBLE_EQ(rougher.vx[0], 5 - 0.5 * 2);
  EXPECT_DOUBLE_EQ(free.vx[0], 5);
}

TEST(GroundContact, LeavesWhatMovesAwayOrIsFar) {
  Soil away = particle({0, 0.05}, {1, 2}, 0.5), far = particle({0, 0.2}, {1, -2}, 0.5);
  contact_with(flat).act(away, 0.1);
  EXPECT_DOUBLE_EQ(away.vy[0], 2);
  EXPECT_DOUBLE_EQ(away.vx[0], 1);
  EXPECT_EQ(contact_with(flat).act(far, 0.1), 0.0);
  EXPECT_DOUBLE_EQ(far.vy[0], -2);
}

TEST(GroundContact, WhatIsDeepInTheGroundIsCountedAndStaysThere) {
  Soil soil = particle({0, -0.7}, {1, -2}, 0.5);
  GroundContact contact = contact_with(flat);
  EXPECT_EQ(contact.act(soil, 0.1), 0.0);
  EXPECT_EQ(contact.lost(), 1);
  EXPECT_DOUBLE_EQ(soil.y[0], -0.7);
}

TEST(GroundContact, AParticleSlidesByCoulombsLaw) {  // a = g (sin 35 - cos 35 tan 20)
  const double slope = 35 * degree, tan_phi = std::tan(20 * degree), dt = 1e-3;
  Soil soil = particle({0, 0.1 / std::cos(slope)}, {0, 0}, tan_phi);
  GroundContact contact = contact_with({{{-100, 100 * std::tan(slope)}, {100, -100 * std::tan(slope)}}, false});
  for (int step = 0; step < 2000; ++step) {
    soil.vy[0] -= 9.81 * dt;
    soil.x[0] += dt * soil.vx[0];
    soil.y[0] += dt * soil.vy[0];
    contact.act(soil, dt * norm(soil.velocity(0)));
  }
  EXPECT_NEAR(norm(soil.velocity(0)), 2.0 * 9.81 * (std::sin(slope) - std::cos(slope) * tan_phi), 1e-9);
}

/// Depth of a point below an open bed [m]: by the parity of crossings, independent of the solver's own distance.
double depth_below(const Polyline& bed, Vec2 p) {
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
Polyline random_bed(std::mt19937& random) {
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
  Polyline bed{{{0, 20}, {8, 20}}, false};
  double x = 8, y = 20;
  while (x < 34) {
    switch (std::uniform_int_distribution<int>(0, 5)(random)) {
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

/// Lets a block fall onto random beds and slide.
/// @return the deepest that any particle was in the ground at any step [dx]
double deepest_on_random_beds(int from, int to) {
  double deepest = -1e300;
  for (int seed = from; seed < to; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const Polyline bed = random_bed(random);
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
    Simulation simulation(m, plan_particles(m), material_properties(m, plan_particles(m)));
    double deepest_here = -1e300;
    try {
      while (!simulation.finished()) {
        simulation.step(m.time.end);
        if (simulation.steps() % 10 != 0) continue;
        for (std::size_t i = 0; i < simulation.soil().n_active; ++i)
          deepest_here = std::max(deepest_here, depth_below(bed, simulation.soil().position(i)) / m.dx);
      }
    } catch (const std::exception& e) {
      ADD_FAILURE() << "bed " << seed << ": " << e.what();
    }
    EXPECT_EQ(simulation.result().penetrated, 0) << "bed " << seed;
    EXPECT_LT(deepest_here, 1e-6) << "bed " << seed;
    deepest = std::max(deepest, deepest_here);
  }
  return deepest;
}

TEST(GroundContact, HoldsOnRandomBeds) { EXPECT_LT(deepest_on_random_beds(0, 40), 1e-6); }
TEST(GroundContactSlow, HoldsOnTwoThousandRandomBeds) { EXPECT_LT(deepest_on_random_beds(40, 2040), 1e-6); }

}  // namespace
}  // namespace talus

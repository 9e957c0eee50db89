#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.hpp"
#include "simulation/checks.hpp"
#include "simulation/particle_setup.hpp"
#include "simulation/reach.hpp"
#include "simulation/simulation.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// A wedge on a slope of 1 in 2 above a flat of 30 m, its crest at (0, 14).
Model wedge(std::vector<Vec2> beyond = {}) {
  Model m;
  std::vector<Vec2> bed{{0, 10}, {20, 0}, {50, 0}};
  bed.insert(bed.end(), beyond.begin(), beyond.end());
  set_ground(m, {bed, false, true, false, 14, {}});
  m.slide = {{{{0, 10}, {16, 2}, {0, 14}}, 0}};
  m.materials = {{"soil", 2000, 25 * degree, 0, 0}};
  m.dx = 0.5;
  m.time.end = 1.0;
  return m;
}

/// The same seen in a mirror at x = 0, with the wall on the right.
Model mirrored(const Model& m) {
  Model other = m;
  Terrain terrain = m.terrain;
  std::ranges::reverse(terrain.bed);
  for (Vec2& v : terrain.bed) v.x = -v.x;
  std::swap(terrain.left_wall, terrain.right_wall);
  terrain.run_out.to = SlidesTo::left;
  set_ground(other, terrain);
  for (SlidePart& part : other.slide)
    for (Vec2& v : part.outline) v.x = -v.x;
  return other;
}

double front_of(const Model& m) {
  Simulation simulation(m, plan_particles(m));
  while (!simulation.finished()) simulation.step(m.time.end);
  return simulation.result().measures.influence_zone;
}

// The energy line from the crest meets the flat at 14/tan(25 deg) = 30.0 m.
TEST(Reach, AValleyBeyondItChangesNothing) {
  const Model with_valley = wedge({{80, -100}, {300, -100}});
  EXPECT_EQ(fall_height(wedge()), 14.0);
  EXPECT_EQ(fall_height(with_valley), 14.0);
  EXPECT_EQ(fall_height(mirrored(with_valley)), 14.0);
  EXPECT_EQ(sound_speed(with_valley), sound_speed(wedge()));
}

// Both beds are equally long, since the spacing of wall particles divides the length of their row.
TEST(Reach, AValleyBeyondItLeavesTheFront) {
  const auto front = [](std::vector<Vec2> beyond) {
    Model m = wedge(std::move(beyond));
    m.time.end = 3.0;
    return front_of(m);
  };
  const double flat = front({{150, 0}}), valley = front({{80, -40}, {130, -40}});
  EXPECT_GT(flat, 18.0);
  EXPECT_NEAR(valley, flat, 1e-6);
}

TEST(Reach, AValleyWithinItCounts) {
  Model m = wedge({{80, -100}, {300, -100}});
  m.materials[0].phi = std::atan(14.0 / 51.0);  // the line passes 14/51 m over the edge at x = 50
  EXPECT_EQ(fall_height(m), 114.0);
  EXPECT_EQ(fall_height(mirrored(m)), 114.0);
  m.materials[0].phi = std::atan(14.0 / 49.0);
  EXPECT_EQ(fall_height(m), 14.0);
}

// Ground that falls by 1 in 10 beneath a line of 1 in 2: 14 - x/2 = 2 - (x - 20)/10 at x = 25.
TEST(Reach, EndsWhereTheLineMeetsASlope) {
  Model m = wedge();
  set_ground(m, {{{0, 10}, {16, 2}, {20, 2}, {220, -18}}, false, true, false, 14, {}});
  m.slide = {{{{0, 10}, {16, 2}, {0, 14}}, 0}};
  m.materials[0].phi = std::atan(0.5);
  EXPECT_NEAR(fall_height(m), 14.0 - 1.5, 1e-9);
  EXPECT_NEAR(fall_height(mirrored(m)), 14.0 - 1.5, 1e-9);
}

TEST(Reach, EndsAtAHillThatTheLineMeets) {
  Model m = wedge();
  m.materials[0].phi = std::atan(0.2);  // 14 - 0.2 x = 3.8 at x = 51
  set_ground(m, {{{0, 10}, {20, 0}, {50, 0}, {51, 3.7}, {52, -50}}, false, true, false, 14, {}});
  EXPECT_EQ(fall_height(m), 64.0);
  set_ground(m, {{{0, 10}, {20, 0}, {50, 0}, {51, 3.9}, {52, -50}}, false, true, false, 14, {}});
  EXPECT_EQ(fall_height(m), 14.0);
}

TEST(Reach, WithoutFrictionItIsTheWholeBed) {
  Model m = wedge({{80, -100}, {300, -100}});
  m.materials[0].phi = 0.0;
  EXPECT_EQ(fall_height(m), 114.0);
  m = wedge({{80, -100}, {300, -100}});
  m.boundaries[0].slip = WallSlip::free_slip;
  EXPECT_EQ(fall_height(m), 114.0);
  m.boundaries[0].slip = WallSlip::friction;
  m.boundaries[0].phi = std::atan(14.0 / 51.0);
  EXPECT_EQ(fall_height(m), 114.0);
  m.boundaries[0].phi = std::atan(14.0 / 49.0);
  EXPECT_EQ(fall_height(m), 14.0);
}

// A column without lateral stress fails at 2 c cos(phi)/(1 - sin(phi)), for 30 degrees 2 sqrt(3) c.
TEST(Reach, ASlideStandsByCohesionUpToItsCompressiveStrength) {
  Model m = column(4.0, 1.0, 0.1);
  const auto stands = [&](double phi, double c) {
    m.materials[0].phi = phi * degree;
    m.materials[0].c = c;
    return stands_by_cohesion(m);
  };
  const double weight = 2000 * 9.81;
  EXPECT_TRUE(stands(0, 0.51 * weight));
  EXPECT_FALSE(stands(0, 0.49 * weight));
  EXPECT_TRUE(stands(30, 1.01 * weight / std::sqrt(12.0)));
  EXPECT_FALSE(stands(30, 0.99 * weight / std::sqrt(12.0)));
  EXPECT_FALSE(stands(30, 0));
  m.rheology.yield = Yield::regularized;
  EXPECT_FALSE(stands(0, weight)) << "it creeps";
  m.rheology.yield = Yield::elastic;
  m.boundaries[0].slip = WallSlip::free_slip;
  EXPECT_FALSE(stands(0, weight)) << "it slides on its bed";
}

// Water has no run-out while it flows, and needs no excuse where the ground holds it.
TEST(Reach, WaterThatFlowsIsStillMoving) {
  const auto moves = [](Model m) {
    m.materials[0].phi = 0.0;
    m.rheology.yield = Yield::regularized;
    Simulation simulation(m, plan_particles(m));
    while (!simulation.finished()) simulation.step(m.time.end);
    const Quality quality = assess(simulation.facts());
    return std::ranges::any_of(quality.reasons, [](const QualityReason& r) { return r.check == "still_moving"; });
  };
  EXPECT_TRUE(moves(wedge()));
  EXPECT_FALSE(moves(column(2.0, 1.0, 0.1)));
}

}  // namespace
}  // namespace talus

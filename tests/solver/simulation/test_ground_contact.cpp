// Soil never passes the ground, whatever its shape.

#include <gtest/gtest.h>

#include <cmath>

#include "models.hpp"
#include "random_beds.hpp"
#include "simulation/ground_contact.hpp"

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
  return {{std::move(line)}, {friction}, 1.0, {3.0, -9.0}, 1};
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

TEST(GroundContact, CountsTheKineticAndThePotentialEnergyThatItTakes) {
  Soil soil = particle({0, 0.02}, {5, -2}, 0.5);
  soil.m[0] = 7;
  GroundContact contact = contact_with(flat);
  contact.act(soil, 0.1);
  const double kinetic = 0.5 * 7 * (5 * 5 + 2 * 2 - 4 * 4), lift = 7 * 9.0 * 0.08;  // the sliding is slowed from 5 to 4
  EXPECT_NEAR(contact.taken(), kinetic - lift, 1e-12);
  contact.restore({0}, 10.0);
  EXPECT_EQ(contact.taken(), 10.0);
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

/// A block that falls over a cliff whose foot lies `lean` to the right of its crest.
RunResult fall_over_cliff(double lean) {
  Model m;
  set_ground(m, {{{0, 10}, {10, 10}, {10 + lean, 0}, {40, 0}}, false, true, false, 16, 0});
  m.slide = {{{{2, 10}, {10, 10}, {10, 13}, {2, 13}}, 0}};
  m.materials = {{"soil", 2000, 20 * degree, 0, 0}};
  m.dx = 0.5;
  m.numerics.c_s = 60;
  m.time.end = 4.0;
  const ParticlePlan plan = plan_particles(m);
  Simulation simulation(m, plan, material_properties(m, plan));
  while (!simulation.finished()) simulation.step(m.time.end);
  return simulation.result();
}

TEST(GroundContact, AVerticalFaceIsAsGoodAsOneThatLeans) {
  const RunResult vertical = fall_over_cliff(0.0), leaning = fall_over_cliff(1e-6);
  EXPECT_EQ(vertical.penetrated, 0);
  EXPECT_GT(vertical.measures.influence_zone, 11.0) << "soil falls over the edge";
  EXPECT_NEAR(vertical.measures.centre_of_mass_x, leaning.measures.centre_of_mass_x, 0.02);
  EXPECT_NEAR(vertical.measures.influence_zone, leaning.measures.influence_zone, 0.5);
}

TEST(GroundContact, HoldsOnRandomBeds) {
  const RandomBeds seen = slide_over_random_beds(0, 16);
  EXPECT_LT(seen.deepest, 1e-6);
  EXPECT_EQ(seen.diverged, 0);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include "particles/ground.hpp"

namespace talus {
namespace {

double distance(Vec2 point, const Polyline& line) { return Ground({line}).nearest(point).distance; }

TEST(Ground, NearestKnowsTheSoilSide) {
  const Ground ground({{{{0, 0}, {10, 0}}, false}});
  EXPECT_DOUBLE_EQ(ground.nearest({3, 2}).distance, 2.0);
  EXPECT_DOUBLE_EQ(ground.nearest({3, -2}).distance, -2.0);
  EXPECT_EQ(ground.nearest({3, -2}).point, (Vec2{3, 0}));
  EXPECT_EQ(ground.nearest({3, -2}).normal, (Vec2{0, 1}));
  EXPECT_EQ(ground.nearest({3, 0}).normal, (Vec2{0, 1}));  // on the line
}

TEST(Ground, NearestAtCornersOfBothKinds) {
  const Polyline valley{{{0, 2}, {0, 0}, {2, 0}}, false};  // soil inside the corner
  EXPECT_GT(distance({0.1, 0.1}, valley), 0);
  EXPECT_DOUBLE_EQ(distance({-3, -4}, valley), -5.0);
  const Polyline ridge{{{-2, -2}, {0, 0}, {2, -2}}, false};  // soil above the roof
  EXPECT_DOUBLE_EQ(distance({0, 1}, ridge), 1.0);
  EXPECT_LT(distance({0, -0.5}, ridge), 0);
  const Ground::Nearest top = Ground({ridge}).nearest({0, 0});
  EXPECT_DOUBLE_EQ(top.normal.y, 1.0);
}

TEST(Ground, TheNearestOfSeveralLinesDecides) {
  // A floor, and a block on it: a ring that is walked clockwise, so that the soil is outside.
  const Ground ground({{{{-5, 0}, {5, 0}}, false}, {{{1, 0.5}, {1, 2}, {2, 2}, {2, 0.5}}, true}});
  EXPECT_DOUBLE_EQ(ground.nearest({-3, 0.4}).distance, 0.4);
  EXPECT_DOUBLE_EQ(ground.nearest({0.7, 1}).distance, 1 - 0.7);
  EXPECT_DOUBLE_EQ(ground.nearest({1.1, 1}).distance, 1 - 1.1);
  EXPECT_DOUBLE_EQ(ground.nearest({-3, -0.4}).distance, -0.4);
  EXPECT_EQ(ground.nearest({-3, 0.4}).line, 0u);
  EXPECT_EQ(ground.nearest({0.7, 1}).line, 1u);
}

TEST(Ground, PastAnEndThereIsNone) {
  const Ground ground({{{{0, 0}, {5, 1}, {10, 0}}, false}});
  EXPECT_TRUE(ground.nearest({-1, 0}).past_end);
  EXPECT_TRUE(ground.nearest({11, -3}).past_end);
  EXPECT_FALSE(ground.nearest({5, 3}).past_end);
  EXPECT_FALSE(ground.nearest({9, 0.3}).past_end);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include "figures/ground.hpp"
#include "particles/geometry.hpp"
#include "reading.hpp"

namespace talus::figures {
namespace {

const Terrain slope{.bed = {{0, 10}, {10, 0}, {40, 0}}, .wall_top = 15, .run_out = {}};

TEST(Ground, ClippedCutsExactlyAtBothEnds) {
  const std::vector<Vec2> part = clipped(slope.bed, 4, 25);
  ASSERT_EQ(part.size(), 3u);
  EXPECT_EQ(part[0], (Vec2{4, 6}));
  EXPECT_EQ(part[1], (Vec2{10, 0}));
  EXPECT_EQ(part[2], (Vec2{25, 0}));
}

TEST(Ground, ClippedKeepsFacesAndOverhangs) {
  const std::vector<Vec2> cliff = {{0, 10}, {10, 10}, {10, 0}, {40, 0}};
  EXPECT_EQ(clipped(cliff, 10, 20), (std::vector<Vec2>{{10, 10}, {10, 0}, {20, 0}}));
  const std::vector<Vec2> overhang = {{0, 10}, {10, 10}, {6, 4}, {6, 0}, {40, 0}};
  EXPECT_EQ(clipped(overhang, 8, 20), (std::vector<Vec2>{{8, 10}, {10, 10}, {8, 7}, {8, 0}, {20, 0}}))
      << "joined along the cut where it is out of view";
}

TEST(Ground, TheWallsThatStandInViewAreVisible) {
  const auto visible = [](const Terrain& terrain, double lo, double hi) {
    return visible_part(ground_line(terrain), lo, hi);
  };
  EXPECT_EQ(visible(slope, -1, 20).front(), (Vec2{0, 15}));
  EXPECT_EQ(visible(slope, 1, 20).front(), (Vec2{1, 9}));
  Terrain open = slope;
  open.left_wall = false;
  EXPECT_EQ(visible(open, -1, 20).front(), (Vec2{0, 10}));
  open.right_wall = true;
  EXPECT_EQ(visible(open, -1, 50).back(), (Vec2{40, 15}));
}

TEST(Ground, ARingIsWalkedWhole) {
  const std::vector<Vec2> line = visible_part({{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, true}, 1, 2);
  ASSERT_EQ(line.size(), 5u);
  EXPECT_EQ(line.front(), line.back());
}

TEST(Ground, HatchingLiesBehindTheLineAtEvenSteps) {
  // The corner is passed: 3 + 4 long, strokes at 2, 4, 6.
  const std::vector<Stroke> strokes = hatching({{0, 3}, {0, 0}, {4, 0}}, 2.0, 0.5);
  ASSERT_EQ(strokes.size(), 3u);
  EXPECT_EQ(strokes[0].from, (Vec2{0, 1}));
  EXPECT_EQ(strokes[1].from, (Vec2{1, 0}));
  EXPECT_EQ(strokes[2].from, (Vec2{3, 0}));
  EXPECT_LT(strokes[0].along.x, 0);  // left of the wall
  EXPECT_LT(strokes[1].along.y, 0);  // under the bed
  for (const Stroke& s : strokes) EXPECT_NEAR(norm(s.along), 0.5, 1e-12);
}

}  // namespace
}  // namespace talus::figures

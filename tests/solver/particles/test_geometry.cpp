#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "particles/geometry.hpp"

namespace talus {
namespace {

const std::vector<Vec2> triangle{{0, 0}, {4, 0}, {0, 3}};

TEST(Geometry, AreaOfATriangleInEitherOrientation) {
  EXPECT_DOUBLE_EQ(area(triangle), 0.5 * 4 * 3);
  EXPECT_DOUBLE_EQ(area(std::vector<Vec2>{{0, 3}, {4, 0}, {0, 0}}), 0.5 * 4 * 3);
}

TEST(Geometry, CoverIsTheSoilAboveAPoint) {
  EXPECT_DOUBLE_EQ(thickness_above(triangle, {1, 0}), 3.0 - 1 * 0.75);
  EXPECT_DOUBLE_EQ(thickness_above(triangle, {1, 1}), 3.0 - 1 * 0.75 - 1);
  EXPECT_DOUBLE_EQ(thickness_above(triangle, {1, 3}), 0.0);
  EXPECT_DOUBLE_EQ(thickness_above(triangle, {5, 0}), 0.0);
}

TEST(Geometry, CoverOfAnOutlineCrossedFourTimes) {
  const std::vector<Vec2> fork{{0, 0}, {3, 0}, {3, 5}, {0, 5},
                               {0, 4}, {2, 4}, {2, 1}, {0, 1}};  // a C: two prongs at x = 1
  EXPECT_DOUBLE_EQ(thickness_above(fork, {1, 0}), 1.0 + 1.0);
  EXPECT_DOUBLE_EQ(thickness_above(fork, {1, 0.25}), 0.75 + 1.0);
  EXPECT_DOUBLE_EQ(thickness_above(fork, {1, 2}), 1.0);
}

TEST(Geometry, OverburdenWeighsEachLayerWithItsOwnDensity) {
  const std::vector<SlidePart> layers{{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0}, {{{0, 1}, {2, 1}, {2, 4}, {0, 4}}, 1}};
  const std::vector<Material> materials{{"clay", 1800, 0, 0, 0}, {"gravel", 2300, 0, 0, 0}};
  EXPECT_DOUBLE_EQ(mass_above(layers, materials, {1, 0.25}), 0.75 * 1800 + 3 * 2300.0);
  EXPECT_DOUBLE_EQ(mass_above(layers, materials, {1, 3}), 1 * 2300.0);
}

TEST(Geometry, NearestKnowsTheSoilSide) {
  const Polyline line{{{0, 0}, {10, 0}}, false};
  EXPECT_DOUBLE_EQ(project({3, 2}, line).distance, 2.0);
  EXPECT_DOUBLE_EQ(project({3, -2}, line).distance, -2.0);
  EXPECT_EQ(project({3, -2}, line).point, (Vec2{3, 0}));
}

TEST(Geometry, NearestAtCornersOfBothKinds) {
  const Polyline valley{{{0, 2}, {0, 0}, {2, 0}}, false};  // soil inside the corner
  EXPECT_GT(project({0.1, 0.1}, valley).distance, 0);
  EXPECT_DOUBLE_EQ(project({-3, -4}, valley).distance, -5.0);
  const Polyline ridge{{{-2, -2}, {0, 0}, {2, -2}}, false};  // soil above the roof
  EXPECT_DOUBLE_EQ(project({0, 1}, ridge).distance, 1.0);
  EXPECT_LT(project({0, -0.5}, ridge).distance, 0);
}

TEST(Geometry, OffsetOfARightAngleKeepsBothDistances) {
  const Polyline moved = offset_into_rock({{{0, 2}, {0, 0}, {2, 0}}, false}, 0.5);
  EXPECT_NEAR(moved.vertices[1].x, -0.5, 1e-14);
  EXPECT_NEAR(moved.vertices[1].y, -0.5, 1e-14);
  EXPECT_NEAR(moved.vertices[2].y, -0.5, 1e-14);
}

TEST(Geometry, FillTilesARectangleWithCellCentres) {
  const std::vector<Polyline> ground{{{{-1, 0}, {5, 0}}, false}};
  const auto points =
      fill_slide(std::vector<SlidePart>{{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0}}, ground, 0.1, Placement::cells);
  ASSERT_EQ(points.size(), 20u * 10u);
  EXPECT_NEAR(points.front().x.x, 0.05, 1e-12);
  EXPECT_NEAR(points.front().x.y, 0.05, 1e-12);
}

TEST(Geometry, FillOnNodesIncludesTheEdges) {
  const std::vector<Boundary> bed{{.line = {{{-1, 0}, {12, 0}}, false}}};
  const auto ground = wall_lines(bed, 0.1, Placement::nodes);
  const auto points =
      fill_slide(std::vector<SlidePart>{{{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, 0}}, ground, 0.1, Placement::nodes);
  EXPECT_EQ(points.size(), 101u * 41u);  // [Z20] 3.1
}

TEST(Geometry, FillKeepsHalfASpacingFromASlopingBed) {
  const Terrain slope{{{0, 5}, {10, 0}, {20, 0}}, false, true, false, 9, 0};
  const std::vector<Polyline> walls{ground_line(slope)};
  const auto points =
      fill_slide(std::vector<SlidePart>{{{{0, 5}, {10, 0}, {10, 6}, {0, 6}}, 0}}, walls, 0.2, Placement::cells);
  ASSERT_FALSE(points.empty());
  for (const SoilPoint& p : points) EXPECT_GE(signed_distance(p.x, walls), 0.1 - 1e-6);
}

TEST(Geometry, TheNearestOfSeveralLinesDecides) {
  // A floor, and a block on it: a ring that is walked clockwise, so that the soil is outside.
  const std::vector<Polyline> walls{{{{-5, 0}, {5, 0}}, false}, {{{1, 0.5}, {1, 2}, {2, 2}, {2, 0.5}}, true}};
  EXPECT_DOUBLE_EQ(signed_distance({-3, 0.4}, walls), 0.4);
  EXPECT_DOUBLE_EQ(signed_distance({0.7, 1}, walls), 1 - 0.7);
  EXPECT_DOUBLE_EQ(signed_distance({1.1, 1}, walls), 1 - 1.1);
  EXPECT_DOUBLE_EQ(signed_distance({-3, -0.4}, walls), -0.4);
  const std::vector<SlidePart> soil{{{{0, 0}, {3, 0}, {3, 3}, {0, 3}}, 0}};
  for (const SoilPoint& p : fill_slide(soil, walls, 0.25, Placement::cells))
    EXPECT_GE(signed_distance(p.x, walls), 0.125 - 1e-6);
}

TEST(Geometry, FillGivesEachLayerItsMaterial) {
  const std::vector<Polyline> ground{{{{-1, 0}, {5, 0}}, false}};
  const std::vector<SlidePart> layers{{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0}, {{{0, 1}, {2, 1}, {2, 2}, {0, 2}}, 1}};
  for (const SoilPoint& p : fill_slide(layers, ground, 0.25, Placement::cells))
    EXPECT_EQ(p.material, p.x.y > 1 ? 1 : 0);
}

}  // namespace
}  // namespace talus

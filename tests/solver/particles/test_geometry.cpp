#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "particles/geometry.hpp"
#include "particles/ground.hpp"

namespace talus {
namespace {

const std::vector<Vec2> triangle{{0, 0}, {4, 0}, {0, 3}};

TEST(Geometry, AreaOfATriangleInEitherOrientation) {
  EXPECT_DOUBLE_EQ(area(triangle), 0.5 * 4 * 3);
  EXPECT_DOUBLE_EQ(signed_area(triangle), 0.5 * 4 * 3);
  const std::vector<Vec2> clockwise(triangle.rbegin(), triangle.rend());
  EXPECT_DOUBLE_EQ(area(clockwise), 0.5 * 4 * 3);
  EXPECT_DOUBLE_EQ(signed_area(clockwise), -0.5 * 4 * 3);
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

TEST(Geometry, OffsetOfARightAngleKeepsBothDistances) {
  const Polyline moved = offset_into_rock({{{0, 2}, {0, 0}, {2, 0}}, false}, 0.5);
  EXPECT_NEAR(moved.vertices[1].x, -0.5, 1e-14);
  EXPECT_NEAR(moved.vertices[1].y, -0.5, 1e-14);
  EXPECT_NEAR(moved.vertices[2].y, -0.5, 1e-14);
}

}  // namespace
}  // namespace talus

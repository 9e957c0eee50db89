#include <gtest/gtest.h>

#include "math/vec2.hpp"

namespace talus {
namespace {

TEST(Vec2, ProductsOfRotatedAndParallelVectors) {
  const Vec2 a{3, -2}, turned{2, 3};  // a turned by a right angle, counter-clockwise
  EXPECT_EQ(dot(a, turned), 0);
  EXPECT_EQ(cross(a, turned), norm2(a));
  EXPECT_EQ(cross(a, 2.5 * a), 0);
  EXPECT_EQ(dot(a, 2.5 * a), 2.5 * 13);
  EXPECT_DOUBLE_EQ(norm(Vec2{3, 4}), 5);
}

TEST(Vec2, SumsAndDifferences) {
  Vec2 a{1, 2};
  a += {10, 20};
  EXPECT_EQ(a, (Vec2{11, 22}));
  EXPECT_EQ(a - (Vec2{1, 2}), (Vec2{10, 20}));
  EXPECT_EQ((Box{{1, 2}, {4, 8}}.width()), 3);
  EXPECT_EQ((Box{{1, 2}, {4, 8}}.height()), 6);
}

}  // namespace
}  // namespace talus

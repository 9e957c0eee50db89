#include <gtest/gtest.h>

#include <numbers>

#include "math/angle.hpp"

namespace talus {
namespace {

TEST(Angle, HalfATurn) {
  EXPECT_DOUBLE_EQ(radians(180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(degrees(std::numbers::pi), 180.0);
  EXPECT_DOUBLE_EQ(degrees(radians(25.0)), 25.0);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include "integrate/time_step.hpp"

namespace talus {
namespace {

TEST(CourantStep, TakesTheTightestBound) {
  EXPECT_DOUBLE_EQ(courant_step({0.4, 0.12, 100, 0}, 20, 1e-9), 0.4 * 0.12 / 120);
  EXPECT_DOUBLE_EQ(courant_step({0.4, 0.12, 100, 0}, 20, 1e6), 0.4 * std::sqrt(0.12 / 1e6));
  EXPECT_DOUBLE_EQ(courant_step({0.4, 0.12, 100, 50}, 20, 1), 0.125 * 0.12 * 0.12 / 50);
}

}  // namespace
}  // namespace talus

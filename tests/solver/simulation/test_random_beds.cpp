// Soil never passes the ground, over two thousand random beds.

#include "random_beds.hpp"

namespace talus::testing_support {
namespace {

class RandomBedsTest : public ::testing::TestWithParam<int> {};

TEST_P(RandomBedsTest, SoilStaysOnTheGround) {
  const RandomBeds seen = slide_over_random_beds(500 * GetParam(), 500 * (GetParam() + 1));
  EXPECT_LT(seen.deepest, 1e-6);
  EXPECT_LE(seen.diverged,
            1);  // bed 1349: a single particle in a valley with free slip, not much wider than the spacing
}

TEST(RandomOverhangs, HoldNoSoilInside) {
  const RandomBeds seen = slide_over_random_beds(2000, 2200, true);
  EXPECT_LT(seen.deepest, 1e-6);
  EXPECT_EQ(seen.diverged, 0);
}

INSTANTIATE_TEST_SUITE_P(, RandomBedsTest, ::testing::Range(0, 4));

}  // namespace
}  // namespace talus::testing_support

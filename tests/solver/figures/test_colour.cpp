#include <gtest/gtest.h>

#include <array>

#include "example_frame.hpp"
#include "figures/colour.hpp"

namespace talus::figures {
namespace {

TEST(Colour, ValuesAreInTheUnitOfTheColourBar) {
  const Frame frame = test::three_particles();
  EXPECT_DOUBLE_EQ(scale_of(Colour::speed).value(frame, 1), 1.0);
  EXPECT_DOUBLE_EQ(scale_of(Colour::displacement).value(frame, 1), 5.0);
  EXPECT_DOUBLE_EQ(scale_of(Colour::pressure).value(frame, 2), 25.0);
  EXPECT_NEAR(scale_of(Colour::friction_angle).value(frame, 2), 30.0, 1e-12);
}

TEST(Colour, RangesAreRoundAndNeverEmpty) {
  const ColourRange speed = rounded({0.0, 3.3});
  EXPECT_DOUBLE_EQ(speed.lo, 0.0);
  EXPECT_DOUBLE_EQ(speed.hi, 17 * 0.2);
  const ColourRange uniform = rounded({25.0, 25.0});
  EXPECT_LT(uniform.lo, 25.0);
  EXPECT_GT(uniform.hi, 25.0);
  const ColourRange rest = rounded({0.0, 0.0});
  EXPECT_LT(rest.lo, rest.hi);
}

TEST(Colour, WallsDoNotCount) {
  const Frame frame = test::three_particles();
  const std::array<const Frame*, 1> frames{&frame};
  const ColourRange pressure = value_range(frames, Colour::pressure);
  EXPECT_DOUBLE_EQ(pressure.lo, 0.0);
  EXPECT_DOUBLE_EQ(pressure.hi, 25.0);
  EXPECT_NEAR(value_range(frames, Colour::friction_angle).lo, 20.0, 1e-12);
}

}  // namespace
}  // namespace talus::figures

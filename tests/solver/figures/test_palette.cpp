#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "figures/colour.hpp"
#include "reading.hpp"

namespace talus::figures {
namespace {

// Relative luminance, ITU-R BT.709 on linearised sRGB (gamma 2.2 suffices here).
double luminance(std::uint32_t rgb) {
  const auto linear = [&](int shift) { return std::pow(((rgb >> shift) & 0xff) / 255.0, 2.2); };
  return 0.2126 * linear(16) + 0.7152 * linear(8) + 0.0722 * linear(0);
}

TEST(Palette, LightnessRisesThroughout) {
  for (const Palette* palette : {&viridis, &plasma, &magma, &cividis}) {
    for (std::size_t i = 1; i < palette->size(); ++i)
      EXPECT_GT(luminance((*palette)[i]), luminance((*palette)[i - 1])) << i;
  }
}

TEST(Palette, ColourAtIsLinearBetweenStopsAndClamped) {
  EXPECT_EQ(colour_at(viridis, 0.3), viridis[3]);
  EXPECT_EQ(colour_at(viridis, -1.0), viridis.front());
  EXPECT_EQ(colour_at(viridis, 2.0), viridis.back());
  // Half way between #440154 and #482475.
  EXPECT_EQ(colour_at(viridis, 0.05), 0x461365u);
}

// The palest colour of soil that is fastest or went farthest, against white: contrast ratio of WCAG 2.
TEST(Palette, FastAndFarSoilIsSeenOnWhite) {
  for (const Colour colour : {Colour::speed, Colour::displacement}) {
    const double contrast = 1.05 / (luminance(scale_of(colour).palette->back()) + 0.05);
    EXPECT_GT(contrast, 1.4) << scale_of(colour).name;
  }
  EXPECT_EQ(darker_part(viridis, 0.5).back(), viridis[5]);
  EXPECT_EQ(darker_part(viridis, 0.5)[2], viridis[1]);
}

TEST(Palette, CommandNamesEveryStop) {
  const std::string command = palette_command(cividis);
  EXPECT_TRUE(test::contains(command, "0.0 '#00224e'"));
  EXPECT_TRUE(test::contains(command, "1.0 '#fee838'"));
}

}  // namespace
}  // namespace talus::figures

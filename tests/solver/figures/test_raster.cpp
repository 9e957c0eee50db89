#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>

#include "figures/raster.hpp"

namespace talus::figures {
namespace {

std::uint32_t byte(const Image& image, int column, int row, int channel) {
  return static_cast<unsigned char>(image.rgba[static_cast<std::size_t>(4 * (row * image.columns + column) + channel)]);
}

TEST(Raster, CoverageIsTheAreaOfTheDisk) {
  const Disk disk{{3, -2}, 0x102030};
  const Image image = disk_image({&disk, 1}, 1.5, 0.05);
  ASSERT_EQ(image.rgba.size(), 4u * image.columns * image.rows);
  double area = 0;
  Vec2 centre;
  for (int j = 0; j < image.rows; ++j) {
    for (int i = 0; i < image.columns; ++i) {
      const double share = byte(image, i, j, 3) / 255.0;
      area += share * image.pixel * image.pixel;
      centre +=
          share * image.pixel * image.pixel * Vec2{image.first.x + i * image.pixel, image.first.y + j * image.pixel};
      if (share == 1.0) {
        EXPECT_EQ(byte(image, i, j, 0), 0x10u);
        EXPECT_EQ(byte(image, i, j, 1), 0x20u);
        EXPECT_EQ(byte(image, i, j, 2), 0x30u);
      }
    }
  }
  EXPECT_NEAR(area, std::numbers::pi * 1.5 * 1.5, 0.01 * area);
  EXPECT_NEAR(centre.x / area, 3, 0.01);
  EXPECT_NEAR(centre.y / area, -2, 0.01);
}

TEST(Raster, LaterDisksLieOnTop) {
  const std::vector<Disk> disks{{{0, 0}, 0xff0000}, {{0, 0}, 0x00ff00}};
  const Image image = disk_image(disks, 1, 0.5);
  EXPECT_EQ(byte(image, 2, 2, 0), 0u);
  EXPECT_EQ(byte(image, 2, 2, 1), 255u);
}

TEST(Raster, RowsRunUpwards) {
  const std::vector<Disk> disks{{{0, 0}, 0xff0000}, {{0, 10}, 0x0000ff}};
  const Image image = disk_image(disks, 1, 0.5);
  EXPECT_EQ(byte(image, 2, 2, 0), 255u);
  EXPECT_EQ(byte(image, 2, image.rows - 3, 2), 255u);
  EXPECT_EQ(byte(image, 2, image.rows / 2, 3), 0u);
}

TEST(Raster, SizeIsBoundedHoweverFarADiskLies) {
  const std::vector<Disk> disks{{{0, 0}, 1}, {{1e6, 1e6}, 1}};
  const Image image = disk_image(disks, 0.1, 0.01);
  EXPECT_LE(image.rgba.size(), 4u * 4'100'000u);
  EXPECT_TRUE(disk_image({}, 1, 1).rgba.empty());
}

}  // namespace
}  // namespace talus::figures

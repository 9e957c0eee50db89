#pragma once
// Soil as an image, for vector files of many particles.

#include <cstdint>
#include <span>
#include <string>

#include "math/vec2.hpp"

namespace talus::figures {

/// A disk of one colour.
struct Disk {
  Vec2 centre;        ///< [m]
  std::uint32_t rgb;  ///< 0xRRGGBB
};

/// Pixels from the lower left corner, row by row.
struct Image {
  int columns = 0;
  int rows = 0;
  double pixel = 0.0;  ///< edge of a pixel [m]
  Vec2 first;          ///< centre of the lower left pixel [m]
  std::string rgba;    ///< four bytes a pixel
};

/// The smallest image that holds all disks. Alpha is the share of a pixel's 3 x 3 sample points that some disk covers;
/// where disks overlap the later one is seen.
/// @param radius  of the disks [m]
/// @param pixel   edge of a pixel [m]; made larger if the image had more than 4 million pixels
Image disk_image(std::span<const Disk> disks, double radius, double pixel);

}  // namespace talus::figures

#include "figures/raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace talus::figures {
namespace {

constexpr int samples = 3;  // per pixel, each way
constexpr double max_pixels = 4e6;

// Which disk is seen at each sample point, -1 for none.
struct SampleGrid {
  Vec2 lo;
  double step;
  int nx, ny;
  std::vector<std::int32_t> disk;

  void draw(std::int32_t index, Vec2 centre, double radius) {
    const auto first = [&](double c, double o) {
      return std::max(0, static_cast<int>(std::ceil((c - radius - o) / step - 0.5)));
    };
    const auto last = [&](double c, double o, int n) {
      return std::min(n - 1, static_cast<int>(std::floor((c + radius - o) / step - 0.5)));
    };
    for (int j = first(centre.y, lo.y); j <= last(centre.y, lo.y, ny); ++j) {
      for (int i = first(centre.x, lo.x); i <= last(centre.x, lo.x, nx); ++i) {
        const Vec2 at{lo.x + (i + 0.5) * step, lo.y + (j + 0.5) * step};
        if (norm2(at - centre) <= radius * radius) disk[static_cast<std::size_t>(j) * nx + i] = index;
      }
    }
  }
};

// Red, green, blue and alpha of a pixel from its sample points.
std::array<std::uint32_t, 4> pixel_of(const SampleGrid& grid, std::span<const Disk> disks, int i, int j) {
  std::array<std::uint32_t, 4> sum{};
  std::uint32_t covered = 0;
  for (int b = 0; b < samples; ++b) {
    for (int a = 0; a < samples; ++a) {
      const std::int32_t d = grid.disk[static_cast<std::size_t>(samples * j + b) * grid.nx + samples * i + a];
      if (d < 0) continue;
      ++covered;
      const std::uint32_t rgb = disks[static_cast<std::size_t>(d)].rgb;
      sum[0] += (rgb >> 16) & 0xff;
      sum[1] += (rgb >> 8) & 0xff;
      sum[2] += rgb & 0xff;
    }
  }
  if (covered == 0) return {};
  return {sum[0] / covered, sum[1] / covered, sum[2] / covered, 255 * covered / (samples * samples)};
}

}  // namespace

Image disk_image(std::span<const Disk> disks, double radius, double pixel) {
  if (disks.empty()) return {};
  Box box{disks.front().centre, disks.front().centre};
  for (const Disk& d : disks) {
    box.include(d.centre - Vec2{radius, radius});
    box.include(d.centre + Vec2{radius, radius});
  }
  Image image;
  image.pixel = std::max(pixel, std::sqrt(box.width() * box.height() / max_pixels));
  image.columns = static_cast<int>(std::ceil(box.width() / image.pixel));
  image.rows = static_cast<int>(std::ceil(box.height() / image.pixel));
  image.first = box.lo + Vec2{image.pixel / 2, image.pixel / 2};
  SampleGrid grid{box.lo, image.pixel / samples, samples * image.columns, samples * image.rows, {}};
  grid.disk.assign(static_cast<std::size_t>(grid.nx) * grid.ny, -1);
  for (std::size_t d = 0; d < disks.size(); ++d) grid.draw(static_cast<std::int32_t>(d), disks[d].centre, radius);
  for (int j = 0; j < image.rows; ++j) {
    for (int i = 0; i < image.columns; ++i) {
      for (const std::uint32_t byte : pixel_of(grid, disks, i, j)) image.rgba += static_cast<char>(byte);
    }
  }
  return image;
}

}  // namespace talus::figures

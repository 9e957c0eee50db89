#include "figures/palette.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace talus::figures {

std::string palette_command(const Palette& palette) {
  std::string command = "set palette defined (";
  for (std::size_t i = 0; i < palette.size(); ++i) {
    char stop[32];
    std::snprintf(stop, sizeof stop, "%s%.1f '#%06x'", i == 0 ? "" : ", ", 0.1 * static_cast<double>(i), palette[i]);
    command += stop;
  }
  return command + ")";
}

std::uint32_t colour_at(const Palette& palette, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(palette.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), palette.size() - 2);
  const double share = at - static_cast<double>(below);
  std::uint32_t rgb = 0;
  for (int shift = 16; shift >= 0; shift -= 8) {
    const double a = (palette[below] >> shift) & 0xff;
    const double b = (palette[below + 1] >> shift) & 0xff;
    rgb |= static_cast<std::uint32_t>(std::lround(a + share * (b - a))) << shift;
  }
  return rgb;
}

}  // namespace talus::figures

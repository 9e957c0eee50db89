#pragma once
// Colours that keep their order in grey and for colour-blind eyes, and the quantities that colour the soil.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "simulation/frame.hpp"

namespace talus::figures {

/// Eleven colours at 0, 0.1 .. 1, linear between, as 0xRRGGBB.
using Palette = std::array<std::uint32_t, 11>;

/// The colour maps viridis, plasma, magma and cividis of matplotlib (CC0, S. van der Walt, N. Smith; cividis: Nunez et
/// al. 2018, doi:10.1371/journal.pone.0199239), every tenth of their range. Perceptually uniform, lightness rises
/// throughout.
inline constexpr Palette viridis{0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c,
                                 0x22a884, 0x44bf70, 0x7ad151, 0xbddf26, 0xfde725};
inline constexpr Palette plasma{0x0d0887, 0x41049d, 0x6a00a8, 0x8f0da4, 0xb12a90, 0xcc4778,
                                0xe16462, 0xf2844b, 0xfca636, 0xfcce25, 0xf0f921};
inline constexpr Palette magma{0x000004, 0x140e36, 0x3b0f70, 0x641a80, 0x8c2981, 0xb73779,
                               0xde4968, 0xf7705c, 0xfe9f6d, 0xfecf92, 0xfcfdbf};
inline constexpr Palette cividis{0x00224e, 0x083370, 0x35456c, 0x4f576c, 0x666970, 0x7d7c78,
                                 0x948e77, 0xaea371, 0xc8b866, 0xe5cf52, 0xfee838};

/// Colour at t in [0, 1] (clamped), as 0xRRGGBB.
constexpr std::uint32_t colour_at(const Palette& palette, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(palette.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), palette.size() - 2);
  const double share = at - static_cast<double>(below);
  std::uint32_t rgb = 0;
  for (int shift = 16; shift >= 0; shift -= 8) {
    const double a = (palette[below] >> shift) & 0xff;
    const double b = (palette[below + 1] >> shift) & 0xff;
    rgb |= static_cast<std::uint32_t>(a + share * (b - a) + 0.5) << shift;
  }
  return rgb;
}

/// A palette from its start to `share` of its range. The soil that is fastest or went farthest lies thin on the ground,
/// and the palest colours would be lost on white.
constexpr Palette darker_part(const Palette& palette, double share) {
  Palette part{};
  for (std::size_t k = 0; k < part.size(); ++k)
    part[k] = colour_at(palette, share * static_cast<double>(k) / static_cast<double>(part.size() - 1));
  return part;
}
/// Diverging, blue to vermillion with the lightest in the middle (Okabe & Ito's pair, safe for colour-blind readers).
inline constexpr Palette blue_white_vermillion{0x004a7a, 0x0072b2, 0x4b9cca, 0x8fc1de, 0xc9e0ee, 0xf4f4f4,
                                               0xf7d9c4, 0xeeb08a, 0xe38550, 0xd55e00, 0x943f00};
inline constexpr Palette plasma_on_white = darker_part(plasma, 0.9);
inline constexpr Palette magma_on_white = darker_part(magma, 0.8);

/// Colours of lines, from the set of Okabe and Ito (2008), which colour-blind eyes tell apart.
inline constexpr const char* blue = "#0072B2";
inline constexpr const char* vermillion = "#D55E00";
inline constexpr const char* ink = "#262626";    ///< text, axes, ground line
inline constexpr const char* faint = "#767676";  ///< second-rank text
inline constexpr const char* grid = "#E3E3E3";
inline constexpr const char* ground = "#E9E3D6";  ///< what lies beneath the bed

/// gnuplot's `set palette` command for the palette.
std::string palette_command(const Palette& palette);

/// What the particles are coloured by.
enum class Colour {
  speed,
  friction_angle,
  displacement,
  pressure,
  cohesion,
  unit_weight,
  viscosity,
  friction_stdev,  ///< standard deviations of the properties, in the same order
  cohesion_stdev,
  unit_weight_stdev,
  viscosity_stdev,
  influence  ///< in Frame::stdev [m], negative or positive
};

/// How a quantity is shown.
struct ColourScale {
  const char* name;  ///< "friction angle (°)" and so on, as it stands beside the colour bar
  const Palette* palette;
  double (*value)(const Frame& frame, std::size_t i);  ///< of one particle, in the unit of the name
};
const ColourScale& scale_of(Colour colour);

/// Span of the colour bar, in the unit of the picture.
struct ColourRange {
  double lo;
  double hi;
};

/// Smallest and largest value of the soil of the frames; 0 counts too, except for properties of the soil.
ColourRange value_range(std::span<const Frame* const> frames, Colour colour);
/// The same widened to round numbers; never empty.
ColourRange rounded(ColourRange range);

}  // namespace talus::figures

#pragma once
// The quantities that colour the soil: name, value, palette, range.

#include <span>
#include <string>

#include "figures/palette.hpp"
#include "simulation/frame.hpp"

namespace talus::figures {

/// What the particles are coloured by.
enum class Colour { speed, friction_angle, displacement, pressure };

/// "friction angle (°)" and so on, as it stands beside the colour bar.
std::string colour_name(Colour colour);
/// The quantity of one particle in the unit of the picture: m/s, degrees, m, kPa.
double colour_value(const Frame& frame, std::size_t i, Colour colour);

/// Each quantity has its own palette.
const Palette& palette_of(Colour colour);

/// Span of the colour bar, in the unit of the picture.
struct ColourRange {
  double lo;
  double hi;
};

/// Smallest and largest value of the soil of the frames; 0 counts too, except for friction angles.
ColourRange value_range(std::span<const Frame* const> frames, Colour colour);
/// The same widened to round numbers; never empty.
ColourRange rounded(ColourRange range);

}  // namespace talus::figures

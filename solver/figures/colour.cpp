#include "figures/colour.hpp"

#include <algorithm>
#include <cmath>

#include "figures/canvas.hpp"
#include "math/angle.hpp"

namespace talus::figures {

const Palette& palette_of(Colour colour) {
  switch (colour) {
    case Colour::speed:
      return plasma;
    case Colour::friction_angle:
      return viridis;
    case Colour::displacement:
      return magma;
    case Colour::pressure:
      return cividis;
  }
  return viridis;
}

std::string colour_name(Colour colour) {
  switch (colour) {
    case Colour::speed:
      return "speed (m/s)";
    case Colour::friction_angle:
      return "friction angle (°)";
    case Colour::displacement:
      return "displacement (m)";
    case Colour::pressure:
      return "pressure (kPa)";
  }
  return {};
}

double colour_value(const Frame& frame, std::size_t i, Colour colour) {
  switch (colour) {
    case Colour::speed:
      return norm(frame.velocity[i]);
    case Colour::friction_angle:
      return friction_angle_deg(frame.tan_phi[i]);
    case Colour::displacement:
      return norm(frame.displacement[i]);
    case Colour::pressure:
      return frame.pressure[i] / 1000.0;
  }
  return 0.0;
}

ColourRange value_range(std::span<const Frame* const> frames, Colour colour) {
  ColourRange range{colour == Colour::friction_angle ? 90.0 : 0.0, 0.0};
  for (const Frame* frame : frames) {
    for (std::size_t i = 0; i < frame->n_soil; ++i) {
      const double value = colour_value(*frame, i, colour);
      range.lo = std::min(range.lo, value);
      range.hi = std::max(range.hi, value);
    }
  }
  return range.lo <= range.hi ? range : ColourRange{0.0, 0.0};
}

ColourRange rounded(ColourRange range) {
  const double span = range.hi - range.lo;
  if (range.lo == 0.0 && range.hi < 1e-9) return {0.0, 1.0};
  if (span < 1e-6 * std::abs(range.hi)) return {range.lo - 1.0, range.hi + 1.0};
  const double step = nice_step(span, 10);
  return {step * std::floor(range.lo / step + 1e-9), step * std::ceil(range.hi / step - 1e-9)};
}

}  // namespace talus::figures

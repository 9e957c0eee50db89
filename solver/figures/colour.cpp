#include "figures/colour.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "figures/sheet.hpp"
#include "math/angle.hpp"

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

const ColourScale& scale_of(Colour colour) {
  static constexpr ColourScale scales[] = {
      {"speed (m/s)", &plasma_on_white, [](const Frame& f, std::size_t i) { return norm(f.velocity[i]); }},
      {"friction angle (°)", &viridis, [](const Frame& f, std::size_t i) { return friction_angle_deg(f.tan_phi[i]); }},
      {"displacement (m)", &magma_on_white, [](const Frame& f, std::size_t i) { return norm(f.displacement[i]); }},
      {"pressure (kPa)", &cividis, [](const Frame& f, std::size_t i) { return f.pressure[i] / 1000.0; }},
      {"cohesion (kPa)", &viridis, [](const Frame& f, std::size_t i) { return f.cohesion[i] / 1000.0; }},
      {"unit weight (kN/m3)", &viridis, [](const Frame& f, std::size_t i) { return f.density[i] * 9.81 / 1000.0; }},
      {"viscosity (Pa s)", &viridis, [](const Frame& f, std::size_t i) { return f.viscosity[i]; }},
      {"standard deviation (°)", &magma_on_white, [](const Frame& f, std::size_t i) { return degrees(f.stdev[i]); }},
      {"standard deviation (kPa)", &magma_on_white, [](const Frame& f, std::size_t i) { return f.stdev[i] / 1000.0; }},
      {"standard deviation (kN/m3)", &magma_on_white,
       [](const Frame& f, std::size_t i) { return f.stdev[i] * 9.81 / 1000.0; }},
      {"standard deviation (Pa s)", &magma_on_white, [](const Frame& f, std::size_t i) { return f.stdev[i]; }},
      {"front (m)", &blue_white_vermillion, [](const Frame& f, std::size_t i) { return f.stdev[i]; }}};
  return scales[static_cast<int>(colour)];
}

ColourRange value_range(std::span<const Frame* const> frames, Colour colour) {
  const bool property = colour == Colour::friction_angle || colour >= Colour::cohesion;
  ColourRange range{property ? 1e300 : 0.0, 0.0};
  for (const Frame* frame : frames) {
    for (std::size_t i = 0; i < frame->n_soil; ++i) {
      const double value = scale_of(colour).value(*frame, i);
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

#pragma once
// The sheet of every figure: size, title, source line, panels placed to the pixel, common style.

#include <filesystem>
#include <string>

#include "figures/palette.hpp"
#include "figures/script.hpp"

namespace talus::figures {

/// Size of a figure in px of the .svg; a .png has `png_scale` times as many each way.
struct Canvas {
  double width = 900;
  double height = 560;
};
inline constexpr int png_scale = 2;

/// A rectangle of the canvas in px from its upper left corner.
struct Panel {
  double left, right, top, bottom;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

/// What a figure says about itself.
struct Stamps {
  std::string title;     ///< bold, upper left
  std::string subtitle;  ///< beneath it
  std::string source;    ///< small, lower left: case, version, seed, realization
};

enum class Align { left, centre, right };

/// Starts a figure: style, stamps, multiplot. `reserved` px at the upper right stay free of the title.
Script begin(const Canvas& canvas, const Stamps& stamps, double reserved = 0.0);

/// Where the next plot goes: `set lmargin at screen` and so on.
void place(Script& script, const Canvas& canvas, const Panel& panel);

/// Text at (x, y) px from the upper left corner, vertically centred there; it stays until `unset label`.
void text(Script& script, const Canvas& canvas, double x, double y, std::string_view words, Align align = Align::left,
          int points = 10, bool bold = false, const char* colour = ink);

/// Horizontal colour bar for the plots that follow, its name to the left of it.
void colour_bar(Script& script, const Canvas& canvas, const Panel& bar, std::string_view name);

/// A step of 1, 2 or 5 times a power of ten that divides `range` into about `parts`.
double nice_step(double range, int parts);

/// Draws the figure to a file ending in .svg or .png; written atomically.
/// @throws IoError when gnuplot is missing or fails, the file cannot be written, or has another ending
void save(const Script& script, const Canvas& canvas, const std::filesystem::path& path);

/// A figure ready to be saved.
struct Sheet {
  Script script;
  Canvas canvas;
  void save(const std::filesystem::path& path) const { figures::save(script, canvas, path); }
};

}  // namespace talus::figures

#pragma once
// The sheet of every figure: size, title, source line, panels placed to the pixel, common style.

#include <filesystem>
#include <string>

#include "figures/colour.hpp"
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

/// An axis of a plot: what it shows and where its tics are.
struct Axis {
  double lo, hi;
  double step;             ///< between tics; 0: no tics
  std::string_view label;  ///< quantity with unit
};

enum class Align { left, centre, right };
struct TextStyle {
  Align align = Align::left;
  int points = 10;
  bool bold = false;
  const char* colour = ink;
};

/// A figure: its script and the canvas that it is drawn on.
struct Sheet {
  Canvas canvas;
  Script script;

  /// Starts a figure: style, stamps, multiplot. `reserved` px at the upper right stay free of the title.
  Sheet(const Canvas& canvas, const Stamps& stamps, double reserved = 0.0);

  /// The axes of the plots that follow.
  void axes(const Axis& x, const Axis& y);
  /// Where the next plot goes: `set lmargin at screen` and so on.
  void place(const Panel& panel);
  /// Text at (x, y) px from the upper left corner, vertically centred there; it stays until `unset label`.
  void text(double x, double y, std::string_view words, const TextStyle& style = {});
  /// Horizontal colour bar for the plots that follow, its name to the left of it.
  void colour_bar(const Panel& bar, std::string_view name);

  /// Draws the figure to a file ending in .svg or .png; written atomically.
  /// @throws IoError when gnuplot is missing or fails, the file cannot be written, or has another ending
  void save(const std::filesystem::path& path) const;
};

/// A step of 1, 2 or 5 times a power of ten that divides `range` into about `parts`.
double nice_step(double range, int parts);
/// The same for an axis of `length` px with a tic about every `pitch` px, at least two.
double nice_step(double range, double length, double pitch);

}  // namespace talus::figures

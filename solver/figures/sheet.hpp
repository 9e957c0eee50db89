#pragma once
// A figure under construction: the gnuplot script, with numbers as numbers and text only through literal(), so that
// nothing a user wrote is ever interpreted; and its sheet: size, title, source line, axes, panels placed to the pixel.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "figures/colour.hpp"
#include "math/vec2.hpp"

namespace talus::figures {

/// A number as gnuplot reads it, 7 significant digits; "NaN" for what is not finite.
std::string number(double value);

/// Text as a gnuplot string. Single quotes, in which gnuplot substitutes nothing; control characters become spaces and
/// ' becomes U+2019, because gnuplot 5.4 cannot read a string that starts with an escaped quote.
std::string literal(std::string_view text);

/// `text` cut to at most `max_characters` Unicode characters, the last one "…" where something was cut.
std::string shortened(std::string_view text, std::size_t max_characters);

/// `value` with `digits` decimals, for captions.
std::string fixed(double value, int digits);

/// gnuplot source, one command a call: script("set xrange [", 0.0, ":", 5.0, "]").
class Script {
 public:
  template <class... Parts>
  Script& operator()(const Parts&... parts) {
    (append(parts), ...);
    text_ += '\n';
    return *this;
  }

  /// Defines the datablock $name with one row a line.
  template <class Rows>
  Script& data(std::string_view name, const Rows& rows) {
    (*this)("$", name, " << END_OF_DATA");
    for (const auto& row : rows) data_row(row);
    return (*this)("END_OF_DATA");
  }

  /// Plots the elements one over the other, in their order; `bytes` are the data of an element '-'.
  Script& plot(std::span<const std::string> elements, std::string_view bytes = {});

  const std::string& text() const { return text_; }

 private:
  void append(double value) { text_ += number(value); }
  void append(int value) { text_ += std::to_string(value); }
  void append(std::string_view text) { text_ += text; }
  void data_row(std::span<const double> row);
  void data_row(Vec2 row) { (*this)(row.x, " ", row.y); }

  std::string text_;
};

/// A plot element: columns x, y of a datablock as a line.
std::string line(std::string_view data, const char* colour, double width = 2, bool dashed = false);
/// A plot element: the area between columns lo and hi over x, as in "1:3:4", in transparent blue.
std::string band(std::string_view data, std::string_view columns = "1:3:4", double opacity = 0.22);
/// A plot element: boxes; `columns` are those of boxxyerror: x, y, x low, x high, y low, y high.
std::string boxes(std::string_view data, std::string_view columns, double opacity, const char* colour,
                  std::string_view border);

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
  std::string title;      ///< bold, upper left
  std::string subtitle;   ///< beneath it
  std::string source;     ///< small, lower left: case, version, seed, realization
  std::string note = {};  ///< beneath the subtitle, in vermillion, as note_lines(): what makes the figure doubtful
};

inline constexpr double note_pitch = 18;  ///< px from one line of a note to the next
/// Characters of a note that fit into a line of a canvas.
std::size_t note_characters(const Canvas& canvas);
/// The lines of a note, wrapped between words where they are longer than the canvas is wide.
std::vector<std::string> note_lines(std::string_view note, const Canvas& canvas);

/// An axis of a plot: what it shows and where its tics are.
struct Axis {
  double lo, hi;
  double step;             ///< between tics; 0: no tics
  std::string_view label;  ///< quantity with unit
};

/// Label of a coordinate axis: "x (m)", or "x - 2683000 (m)" where Terrain::origin is not 0.
std::string axis_label(const char* name, double origin);

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

/// What gnuplot made of a script.
struct GnuplotOutput {
  std::string picture;   ///< all it wrote to stdout
  std::string warnings;  ///< all it wrote to stderr
};

/// Runs `gnuplot --default-settings` with `script` as its stdin: no shell, no start-up file.
/// @throws IoError when gnuplot is missing ("install gnuplot-nox") or fails (with its message)
GnuplotOutput run_gnuplot(const std::string& script);

}  // namespace talus::figures

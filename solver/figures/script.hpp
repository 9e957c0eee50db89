#pragma once
// A gnuplot script under construction, and the gnuplot that runs it. Numbers go in as numbers, text only through
// literal(): nothing a user wrote is ever interpreted.

#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// What gnuplot made of a script.
struct GnuplotOutput {
  std::string picture;   ///< all it wrote to stdout
  std::string warnings;  ///< all it wrote to stderr
};

/// Runs `gnuplot --default-settings` with `script` as its stdin: no shell, no start-up file.
/// @throws IoError when gnuplot is missing ("install gnuplot-nox") or fails (with its message)
GnuplotOutput run_gnuplot(const std::string& script);

}  // namespace talus::figures

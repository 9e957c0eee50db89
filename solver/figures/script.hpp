#pragma once
// A gnuplot script under construction. Numbers go in as numbers, text only through literal(): nothing a user wrote is
// ever interpreted.

#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

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

  /// Bytes for a plot of '-', right after its command.
  Script& inline_binary(std::string_view bytes) {
    text_ += bytes;
    return *this;
  }

  const std::string& text() const { return text_; }

 private:
  void append(double value) { text_ += number(value); }
  void append(int value) { text_ += std::to_string(value); }
  void append(std::string_view text) { text_ += text; }
  void data_row(std::span<const double> row);
  void data_row(Vec2 row) { (*this)(row.x, " ", row.y); }

  std::string text_;
};

}  // namespace talus::figures

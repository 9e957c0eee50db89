#include "figures/script.hpp"

#include <cmath>
#include <cstdio>

#include "figures/colour.hpp"

namespace talus::figures {

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.7g", value);
  return buffer;
}

std::string fixed(double value, int digits) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  return buffer;
}

std::string literal(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\'') {
      out += "\u2019";
    } else {
      out += byte < 0x20 || byte == 0x7f ? ' ' : c;
    }
  }
  return out + "'";
}

std::string shortened(std::string_view text, std::size_t max_characters) {
  const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  std::size_t characters = 0;
  std::size_t keep = 0;  // bytes of the first max_characters - 1 characters
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!starts_character(text[i])) continue;
    if (characters + 1 == max_characters) keep = i;
    ++characters;
  }
  return characters <= max_characters ? std::string(text) : std::string(text.substr(0, keep)) + "…";
}

void Script::data_row(std::span<const double> row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) text_ += ' ';
    append(row[i]);
  }
  text_ += '\n';
}

Script& Script::plot(std::span<const std::string> elements, std::string_view bytes) {
  text_ += "plot ";
  for (const std::string& element : elements) text_ += element + ", \\\n  ";
  text_ += "NaN\n";
  text_ += bytes;
  return *this;
}

std::string line(std::string_view data, const char* colour, double width, bool dashed) {
  return "$" + std::string(data) + " using 1:2 with lines " + (dashed ? "dashtype 2 " : "") + "linewidth " +
         number(width) + " linecolor rgb '" + colour + "'";
}

std::string band(std::string_view data, std::string_view columns, double opacity) {
  return "$" + std::string(data) + " using " + std::string(columns) + " with filledcurves fillcolor rgb '" + blue +
         "' fillstyle transparent solid " + number(opacity) + " noborder";
}

std::string boxes(std::string_view data, std::string_view columns, double opacity, const char* colour,
                  std::string_view border) {
  return "$" + std::string(data) + " using " + std::string(columns) + " with boxxyerror fillstyle solid " +
         number(opacity) + " " + std::string(border) + " linecolor rgb '" + colour + "'";
}

}  // namespace talus::figures

#include "figures/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>

#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::figures {
namespace {

constexpr double side_margin = 24;  // px left and right of the stamps
// Mean width of a character [px].
constexpr double px_bold = 8.8;
constexpr double px_text = 6.4;
constexpr double px_small = 5.2;

std::string font(int points, bool bold) {
  return std::string("font 'sans-serif") + (bold ? ":Bold," : ",") + std::to_string(points) + "'";
}

// Screen coordinates run from 0 to 1, upwards.
double across(const Canvas& canvas, double x) { return x / canvas.width; }
double up(const Canvas& canvas, double y) { return 1.0 - y / canvas.height; }

std::string terminal(const Canvas& canvas, bool svg) {
  const int scale = svg ? 1 : png_scale;
  const std::string size = "size " + std::to_string(std::lround(scale * canvas.width)) + "," +
                           std::to_string(std::lround(scale * canvas.height));
  const std::string style = size + " noenhanced font 'sans-serif,10' background '#ffffff'";
  if (svg) return "set terminal svg " + style + "\n";
  const std::string times = std::to_string(scale);
  return "set terminal pngcairo " + style + " fontscale " + times + " linewidth " + times + " pointscale " + times +
         "\n";
}

}  // namespace

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

std::size_t note_characters(const Canvas& canvas) {
  return static_cast<std::size_t>(std::max(1.0, (canvas.width - 2 * side_margin) / px_text));
}

std::vector<std::string> note_lines(std::string_view note, const Canvas& canvas) {
  const std::size_t most = note_characters(canvas);
  std::vector<std::string> lines;
  std::istringstream given{std::string(note)};
  for (std::string line; std::getline(given, line);) {
    std::string fitted;
    std::istringstream words(line);
    for (std::string next; words >> next;) {
      if (!fitted.empty() && fitted.size() + 1 + next.size() > most) lines.push_back(std::exchange(fitted, {}));
      fitted += (fitted.empty() ? "" : " ") + next;
    }
    lines.push_back(fitted);
  }
  return lines;
}

Sheet::Sheet(const Canvas& size, const Stamps& stamps, double reserved) : canvas(size) {
  script("set encoding utf8");
  script("set border 3 linewidth 0.8 linecolor rgb '", ink, "'");
  script("set tics nomirror out scale 0.6 textcolor rgb '", ink, "'");
  script("set grid back linetype 1 dashtype solid linewidth 0.6 linecolor rgb '", grid, "'");
  script("set key noautotitle");
  const auto fitted = [](const std::string& words, double room, double px) {
    return shortened(words, static_cast<std::size_t>(std::max(1.0, room / px)));
  };
  const double room = canvas.width - 2 * side_margin;
  text(side_margin, 26, fitted(stamps.title, room - reserved, px_bold), {.points = 12, .bold = true});
  text(side_margin, 50, fitted(stamps.subtitle, room, px_text), {.colour = faint});
  double y = 70;
  for (const std::string& words : note_lines(stamps.note, canvas)) {
    text(side_margin, y, words, {.colour = vermillion});
    y += note_pitch;
  }
  text(side_margin, canvas.height - 13, fitted(stamps.source, room, px_small), {.points = 8, .colour = faint});
  script("set multiplot");
}

void Sheet::axes(const Axis& x, const Axis& y) {
  for (const auto& [name, axis] : {std::pair{"x", x}, std::pair{"y", y}}) {
    script("set ", name, "range [", axis.lo, ":", axis.hi, "]");
    if (axis.step > 0)
      script("set ", name, "tics ", axis.step);
    else
      script("unset ", name, "tics");
    script("set ", name, "label ", literal(axis.label));
  }
}

void Sheet::place(const Panel& panel) {
  script("set lmargin at screen ", across(canvas, panel.left));
  script("set rmargin at screen ", across(canvas, panel.right));
  script("set tmargin at screen ", up(canvas, panel.top));
  script("set bmargin at screen ", up(canvas, panel.bottom));
}

void Sheet::text(double x, double y, std::string_view words, const TextStyle& style) {
  if (words.empty()) return;
  const char* where = style.align == Align::left ? "left" : style.align == Align::right ? "right" : "center";
  script("set label ", literal(words), " at screen ", across(canvas, x), ", screen ", up(canvas, y), " ", where,
         " front ", font(style.points, style.bold), " textcolor rgb '", style.colour, "'");
}

void Sheet::colour_bar(const Panel& bar, std::string_view name) {
  script("set colorbox horizontal user origin screen ", across(canvas, bar.left), ", screen ", up(canvas, bar.bottom),
         " size screen ", bar.width() / canvas.width, ", screen ", bar.height() / canvas.height, " noborder front");
  script("set cbtics nomirror out scale 0.4 offset 0,0.5 ", font(9, false));
  text(bar.left - 10, 0.5 * (bar.top + bar.bottom), name, {.align = Align::right});
}

void Sheet::save(const std::filesystem::path& path) const {
  const bool svg = path.extension() == ".svg";
  if (!svg && path.extension() != ".png") throw IoError(path.string() + ": a figure file must end in .svg or .png");
  std::string picture = run_gnuplot(terminal(canvas, svg) + script.text()).picture;
  // gnuplot's svg terminal takes "sans-serif:Bold" for the name of a family.
  const std::string bold = "font-family=\"sans-serif:Bold\"";
  for (std::size_t at = 0; svg && (at = picture.find(bold, at)) != std::string::npos;)
    picture.replace(at, bold.size(), "font-family=\"sans-serif\" font-weight=\"bold\"");
  write_file_atomically(path, picture);
}

std::string axis_label(const char* name, double origin) {
  if (origin == 0.0) return std::string(name) + " (m)";
  return std::string(name) + (origin > 0.0 ? " - " : " + ") + to_text(std::abs(origin)) + " (m)";
}

double nice_step(double range, int parts) {
  const double rough = range / parts;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / decade;
  return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

double nice_step(double range, double length, double pitch) {
  return nice_step(range, std::max(2, static_cast<int>(length / pitch)));
}

}  // namespace talus::figures

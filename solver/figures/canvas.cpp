#include "figures/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "figures/gnuplot.hpp"
#include "support/error.hpp"
#include "support/files.hpp"

namespace talus::figures {
namespace {

constexpr double margin = 24;  // px left and right of the stamps
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

// gnuplot's svg terminal takes "sans-serif:Bold" for the name of a family.
void spell_bold_as_weight(std::string& svg) {
  const std::string_view wrong = "font-family=\"sans-serif:Bold\"";
  for (std::size_t at = 0; (at = svg.find(wrong, at)) != std::string::npos;) {
    svg.replace(at, wrong.size(), "font-family=\"sans-serif\" font-weight=\"bold\"");
  }
}

}  // namespace

Script begin(const Canvas& canvas, const Stamps& stamps, double reserved) {
  Script script;
  script("set encoding utf8");
  script("set border 3 linewidth 0.8 linecolor rgb '", ink, "'");
  script("set tics nomirror out scale 0.6 textcolor rgb '", ink, "'");
  script("set grid back linetype 1 dashtype solid linewidth 0.6 linecolor rgb '", grid, "'");
  script("set key noautotitle");
  const auto fitted = [](const std::string& words, double room, double px) {
    return shortened(words, static_cast<std::size_t>(std::max(1.0, room / px)));
  };
  const double room = canvas.width - 2 * margin;
  text(script, canvas, margin, 26, fitted(stamps.title, room - reserved, px_bold), Align::left, 12, true);
  text(script, canvas, margin, 50, fitted(stamps.subtitle, room, px_text), Align::left, 10, false, faint);
  text(script, canvas, margin, canvas.height - 13, fitted(stamps.source, room, px_small), Align::left, 8, false, faint);
  script("set multiplot");
  return script;
}

void place(Script& script, const Canvas& canvas, const Panel& panel) {
  script("set lmargin at screen ", across(canvas, panel.left));
  script("set rmargin at screen ", across(canvas, panel.right));
  script("set tmargin at screen ", up(canvas, panel.top));
  script("set bmargin at screen ", up(canvas, panel.bottom));
}

void text(Script& script, const Canvas& canvas, double x, double y, std::string_view words, Align align, int points,
          bool bold, const char* colour) {
  if (words.empty()) return;
  const char* where = align == Align::left ? "left" : align == Align::right ? "right" : "center";
  script("set label ", literal(words), " at screen ", across(canvas, x), ", screen ", up(canvas, y), " ", where,
         " front ", font(points, bold), " textcolor rgb '", colour, "'");
}

void colour_bar(Script& script, const Canvas& canvas, const Panel& bar, std::string_view name) {
  script("set colorbox horizontal user origin screen ", across(canvas, bar.left), ", screen ", up(canvas, bar.bottom),
         " size screen ", bar.width() / canvas.width, ", screen ", bar.height() / canvas.height, " noborder front");
  script("set cbtics nomirror out scale 0.4 offset 0,0.5 ", font(9, false));
  text(script, canvas, bar.left - 10, 0.5 * (bar.top + bar.bottom), name, Align::right);
}

double nice_step(double range, int parts) {
  const double rough = range / parts;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / decade;
  return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

void save(const Script& script, const Canvas& canvas, const std::filesystem::path& path) {
  const bool svg = path.extension() == ".svg";
  if (!svg && path.extension() != ".png") throw IoError(path.string() + ": a figure file must end in .svg or .png");
  std::string picture = run_gnuplot(terminal(canvas, svg) + script.text()).picture;
  if (svg) spell_bold_as_weight(picture);
  write_file_atomically(path, picture);
}

}  // namespace talus::figures

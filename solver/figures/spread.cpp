#include <algorithm>
#include <array>
#include <limits>

#include "figures/charts.hpp"
#include "support/measures.hpp"

namespace talus::figures {
namespace {

constexpr Canvas spread_canvas{900, 520};
constexpr Panel spread_panel{190, 812, 84, 440};
constexpr double rows = static_cast<double>(measure_table.size());
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Length and interval of a bar at height `row`.
using Row = std::array<double, 4>;

Row spread_row(const Quantity& q, double row) {
  const Interval interval = q.stdev_ci95.value_or(Interval{});
  return {q.stdev.value_or(unknown), interval.lo.value_or(unknown), interval.hi.value_or(unknown), row};
}

void legend(Script& script, double x, const char* colour, const char* name) {
  text(script, spread_canvas, x, 72, "■", Align::left, 10, false, colour);
  text(script, spread_canvas, x + 16, 72, name);
}

}  // namespace

Sheet spread_sheet(const StudyFiles& study) {
  Sheet sheet{begin(spread_canvas,
                    chart_stamps(study, "Standard deviation from soil variability, compared with the numerical noise")),
              spread_canvas};
  Script& script = sheet.script;
  legend(script, spread_panel.left, blue, "standard deviation, 95 % interval");
  legend(script, spread_panel.left + 260, vermillion, "numerical noise");
  std::vector<Row> spread;
  std::vector<Row> floor;
  double widest = 0.0;
  double row = rows + 1.0;
  for (const Measure& measure : measure_table) {
    row -= 1.0;
    const double y = spread_panel.bottom - (row - 0.4) / (rows + 0.2) * spread_panel.height();
    text(script, spread_canvas, spread_panel.left - 10, y, measure.label, Align::right);
    const auto found = study.quantities.find(measure.key);
    if (found == study.quantities.end()) continue;
    const Quantity& q = found->second;
    spread.push_back(spread_row(q, row + 0.16));
    floor.push_back({q.noise_floor_stdev.value_or(unknown), unknown, unknown, row - 0.2});
    const double reach = std::max({q.stdev.value_or(0.0), spread.back()[2], q.noise_floor_stdev.value_or(0.0)});
    widest = std::max(widest, reach == reach ? reach : q.stdev.value_or(0.0));
    const std::string values = fixed(q.stdev.value_or(0.0), 3) + " / " +
                               (q.noise_floor_stdev ? fixed(*q.noise_floor_stdev, 3) : std::string("–"));
    text(script, spread_canvas, spread_canvas.width - 24, y, values, Align::right, 9, false, faint);
  }
  if (widest <= 0.0) widest = 1.0;
  script.data("spread", spread).data("floor", floor);
  script("set xrange [0:", 1.04 * widest, "]");
  script("set yrange [0.4:", rows + 0.6, "]");
  script("set xtics ", nice_step(widest, 6));
  script("unset ytics");
  script("set border 1");
  script("set xlabel 'standard deviation over the realizations (m)'");
  place(script, spread_canvas, spread_panel);
  script(
      "plot $spread using ($1/2):4:(0):1:($4-0.16):($4+0.16) with boxxyerror fillstyle solid 0.75 noborder linecolor "
      "rgb '",
      blue, "', \\");
  script("  $spread using 1:4:2:3 with xerrorbars pointtype 0 linewidth 1 linecolor rgb '", ink, "', \\");
  script("  $floor using ($1/2):4:(0):1:($4-0.14):($4+0.14) with boxxyerror fillstyle solid 0.9 border rgb '",
         vermillion, "' linecolor rgb '", vermillion, "'");
  return sheet;
}

}  // namespace talus::figures

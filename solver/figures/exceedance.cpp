#include <array>

#include "figures/charts.hpp"

namespace talus::figures {
namespace {

constexpr double least_beyond = 5;  // fewer runs beyond a quantile say too little about it

// A point of the curve that readers ask for.
void mark(Script& script, const StudyFiles& study, double quantile, const char* name) {
  const Quantity& q = study.quantities.at("influence_zone_m");
  const auto found = q.quantiles.find(quantile);
  if (found == q.quantiles.end() || (1.0 - quantile) * static_cast<double>(study.done) < least_beyond - 1e-9) return;
  const double x = found->second;
  script("set label ", literal(std::string(name) + ": " + fixed(x, 2) + " m"), " at ", x, ",", 1.0 - quantile,
         " left offset 1.2,0.5 front point pointtype 7 pointsize 0.6 linecolor rgb '", vermillion, "' textcolor rgb '",
         ink, "'");
}

}  // namespace

Sheet exceedance_sheet(const StudyFiles& study) {
  const Quantity& q = study.quantities.at("influence_zone_m");
  const std::string subtitle =
      std::string("Probability that the run-out exceeds x, given failure. Band: 95 % (Wilson)") +
      (study.failed > 0 ? ", widened to allow for failed runs (none to all of them exceed x)" : "");
  Sheet sheet{begin(chart_canvas, chart_stamps(study, subtitle)), chart_canvas};
  Script& script = sheet.script;
  std::vector<std::array<double, 4>> rows;
  for (const Exceedance& e : q.exceedance) rows.push_back({e.x, e.p, e.lo, e.hi});
  script.data("curve", rows);
  const double lo = rows.empty() ? 0.0 : rows.front()[0];
  const double hi = rows.empty() ? 1.0 : rows.back()[0];
  const double spare = hi > lo ? 0.06 * (hi - lo) : 1.0;
  script("set xrange [", lo - spare, ":", hi + 3 * spare, "]");
  script("set yrange [0:1.02]");
  script("set xtics ", nice_step(hi - lo + 4 * spare, 8));
  script("set ytics 0.1");
  script("set xlabel 'x (m), from the left boundary'");
  script("set ylabel 'probability of exceedance'");
  mark(script, study, 0.5, "half of the runs");
  mark(script, study, 0.9, "1 in 10");
  mark(script, study, 0.99, "1 in 100");
  place(script, chart_canvas, chart_panel);
  script("plot $curve using 1:3:4 with filledcurves fillcolor rgb '", blue,
         "' fillstyle transparent solid 0.22 noborder, \\");
  script("  $curve using 1:2 with lines linewidth 2 linecolor rgb '", blue, "'");
  return sheet;
}

}  // namespace talus::figures

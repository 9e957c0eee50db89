#include <algorithm>
#include <array>

#include "figures/charts.hpp"
#include "statistics/sample.hpp"

namespace talus::figures {
namespace {

Vec2 range_of(std::span<const double> values) {
  if (values.empty()) return {0, 1};
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  const double spare = *hi > *lo ? 0.06 * (*hi - *lo) : 0.5;
  return {*lo - spare, *hi + spare};
}

// Least squares: y = mean(y) + r s_y / s_x (x - mean(x)).
double fitted(const SampleMoments& x, const SampleMoments& y, double r, double at) {
  return *y.mean + r * *y.stdev / *x.stdev * (at - *x.mean);
}

}  // namespace

Sheet friction_angle_sheet(const StudyFiles& study) {
  std::vector<double> phi;
  std::vector<double> zone;
  std::vector<std::array<double, 2>> rows;
  for (const Done& r : study.realizations) {
    phi.push_back(r.mean_phi_deg);
    zone.push_back(r.influence_zone);
    rows.push_back({r.mean_phi_deg, r.influence_zone});
  }
  const std::optional<double> r = correlation(phi, zone);
  const std::string words =
      r ? "Correlation " + fixed(*r, 2) + "; dashed: least squares" : std::string("One point per run");
  Sheet sheet{begin(chart_canvas, chart_stamps(study, words)), chart_canvas};
  Script& script = sheet.script;
  const Vec2 x = range_of(phi);
  const Vec2 y = range_of(zone);
  script.data("runs", rows);
  script("set xrange [", x.x, ":", x.y, "]");
  script("set yrange [", y.x, ":", y.y, "]");
  script("set xtics ", nice_step(x.y - x.x, 8));
  script("set ytics ", nice_step(y.y - y.x, 8));
  script("set xlabel 'mean friction angle of the slide (°)'");
  script("set ylabel 'run-out distance (m)'");
  place(script, chart_canvas, chart_panel);
  std::string line;
  if (r) {
    const SampleMoments mx = moments(phi);
    const SampleMoments my = moments(zone);
    script.data("fit", std::array<Vec2, 2>{Vec2{x.x, fitted(mx, my, *r, x.x)}, Vec2{x.y, fitted(mx, my, *r, x.y)}});
    line = std::string(", $fit using 1:2 with lines dashtype 2 linewidth 1.2 linecolor rgb '") + vermillion + "'";
  }
  script("plot $runs using 1:2 with points pointtype 7 pointsize 0.5 linecolor rgb '#660072B2'", line);
  return sheet;
}

}  // namespace talus::figures

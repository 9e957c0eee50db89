#include <algorithm>
#include <array>
#include <limits>

#include "figures/charts.hpp"
#include "statistics/sample.hpp"

namespace talus::figures {
namespace {

constexpr std::size_t points = 300;  // along the curve, at most
constexpr double settled = 8;        // intervals of fewer realizations may leave the picture
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// n, mean, lower and upper end of the interval of the first n realizations done.
std::vector<std::array<double, 4>> running_means(const std::vector<Done>& realizations) {
  std::vector<double> sample;
  for (const Done& r : realizations) sample.push_back(r.influence_zone);
  const std::size_t stride = 1 + sample.size() / points;
  std::vector<std::array<double, 4>> rows;
  for (std::size_t n = 1; n <= sample.size(); ++n) {
    if (n % stride != 0 && n != sample.size()) continue;
    const SampleMoments m = moments(std::span(sample).first(n));
    const Interval interval = m.mean_ci95.value_or(Interval{});
    rows.push_back({static_cast<double>(n), *m.mean, interval.lo.value_or(unknown), interval.hi.value_or(unknown)});
  }
  return rows;
}

// All means, and the intervals once they have settled.
Vec2 y_range(const std::vector<std::array<double, 4>>& rows) {
  Vec2 range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  const auto include = [&range](double y) {
    range.x = std::min(range.x, y);
    range.y = std::max(range.y, y);
  };
  const double last = rows.back()[0];
  for (const auto& [n, mean, lo, hi] : rows) {
    include(mean);
    if (n < std::min(settled, last) || lo != lo) continue;
    include(lo);
    include(hi);
  }
  const double spare = range.y > range.x ? 0.06 * (range.y - range.x) : 0.1;
  return {range.x - spare, range.y + spare};
}

}  // namespace

Sheet running_mean_sheet(const StudyFiles& study) {
  const Quantity& q = study.quantities.at("influence_zone_m");
  Sheet sheet{begin(chart_canvas,
                    chart_stamps(study, "Mean run-out distance of the first n runs: " +
                                            interval_text(q.mean, q.mean_ci95) + ". Band: 95 % interval (Student)")),
              chart_canvas};
  Script& script = sheet.script;
  const auto rows = running_means(study.realizations);
  if (rows.empty()) return sheet;
  const Vec2 y = y_range(rows);
  script.data("means", rows);
  script.data("final", std::array<Vec2, 2>{Vec2{0, rows.back()[1]}, Vec2{rows.back()[0], rows.back()[1]}});
  script("set xrange [0:", 1.02 * std::max(2.0, rows.back()[0]), "]");
  script("set yrange [", y.x, ":", y.y, "]");
  script("set xtics ", std::max(1.0, nice_step(rows.back()[0], 8)));
  script("set ytics ", nice_step(y.y - y.x, 8));
  script("set xlabel 'realizations n'");
  script("set ylabel 'mean run-out distance (m)'");
  place(script, chart_canvas, chart_panel);
  script("plot $means using 1:3:4 with filledcurves fillcolor rgb '", blue,
         "' fillstyle transparent solid 0.22 noborder, \\");
  script("  $final using 1:2 with lines dashtype 2 linewidth 1 linecolor rgb '", vermillion, "', \\");
  script("  $means using 1:2 with lines linewidth 2 linecolor rgb '", blue, "'");
  return sheet;
}

}  // namespace talus::figures

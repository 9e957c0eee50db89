#include <algorithm>
#include <array>
#include <cstdint>

#include "figures/charts.hpp"

namespace talus::figures {
namespace {

constexpr Canvas histogram_canvas{900, 616};
constexpr Panel bars{166, 872, 84, 420};
constexpr Panel strip{166, 872, 428, 532};

// What the strip beneath the bars shows: lo to hi at the mean, at height `row`.
struct Bar {
  const char* name;
  double lo, hi;
  double row;
  const char* colour;
};

std::vector<Bar> strip_bars(const Quantity& q) {
  std::vector<Bar> all;
  if (q.mean_ci95 && q.mean_ci95->lo && q.mean_ci95->hi)
    all.push_back({"mean, 95 % interval", *q.mean_ci95->lo, *q.mean_ci95->hi, 3, vermillion});
  if (q.mean && q.stdev) all.push_back({"± standard deviation", *q.mean - *q.stdev, *q.mean + *q.stdev, 2, blue});
  if (q.mean && q.noise_floor_stdev) {
    all.push_back({"± numerical noise", *q.mean - *q.noise_floor_stdev, *q.mean + *q.noise_floor_stdev, 1, faint});
  }
  return all;
}

void draw_bars(Script& script, const Quantity& q) {
  const Histogram& h = q.histogram;
  std::vector<std::array<double, 3>> rows;
  for (std::size_t i = 0; i < h.counts.size(); ++i)
    rows.push_back({h.edges[i], h.edges[i + 1], static_cast<double>(h.counts[i])});
  script.data("bins", rows);
  const double top =
      h.counts.empty()
          ? 1.0
          : static_cast<double>(std::max<std::int64_t>(1, *std::max_element(h.counts.begin(), h.counts.end())));
  script("set yrange [0:", 1.08 * top, "]");
  script("set ytics ", std::max(1.0, nice_step(top, 6)));
  script("set ylabel 'realizations'");
  script("set format x ''");
  if (q.mean) script.data("mean", std::array<Vec2, 2>{Vec2{*q.mean, 0}, Vec2{*q.mean, 1.08 * top}});
  script(
      "plot $bins using (0.5*($1+$2)):($3/2.0):1:2:(0):3 with boxxyerror fillstyle solid 0.75 border rgb '#ffffff' "
      "linecolor rgb '",
      blue, "'",
      q.mean ? std::string(", $mean using 1:2 with lines linewidth 1.6 linecolor rgb '") + vermillion + "'" : "");
}

void draw_strip(Script& script, const std::vector<Bar>& all) {
  script("unset label");
  script("set yrange [0.4:3.6]");
  script("unset ytics");
  script("unset ylabel");
  script("set border 1");
  script("set format x '%g'");
  script("set xlabel 'run-out distance (m): farthest particle, from the left boundary'");
  std::string plot;
  for (const Bar& bar : all) {
    const std::string name = "strip" + number(bar.row);
    script.data(name, std::array<std::array<double, 3>, 1>{{{bar.lo, bar.hi, bar.row}}});
    text(script, histogram_canvas, strip.left - 10, strip.bottom - (bar.row - 0.4) / 3.2 * strip.height(), bar.name,
         Align::right, 10, false, bar.colour);
    plot += std::string(plot.empty() ? "" : ", ") + "$" + name +
            " using (0.5*($1+$2)):3:1:2:($3-0.25):($3+0.25) with boxxyerror fillstyle solid 0.9 border rgb '" +
            bar.colour + "' linecolor rgb '" + bar.colour + "'";
  }
  script("plot ", plot.empty() ? "NaN" : plot);
}

// Bins and strip, and half a bin to spare.
Vec2 x_range(const Quantity& q, const std::vector<Bar>& all) {
  double lo = q.mean.value_or(0.0);
  double hi = lo;
  const auto& edges = q.histogram.edges;
  if (!edges.empty()) {
    const double spare = 0.5 * (edges[1] - edges[0]);
    lo = edges.front() - spare;
    hi = edges.back() + spare;
  }
  for (const Bar& bar : all) {
    lo = std::min(lo, bar.lo);
    hi = std::max(hi, bar.hi);
  }
  return hi > lo ? Vec2{lo, hi} : Vec2{lo - 1, hi + 1};
}

}  // namespace

Sheet histogram_sheet(const StudyFiles& study) {
  const Quantity& q = study.quantities.at("influence_zone_m");
  std::string subtitle = "Mean " + interval_text(q.mean, q.mean_ci95) + ", standard deviation " +
                         interval_text(q.stdev, q.stdev_ci95) + ", numerical noise " +
                         (q.noise_floor_stdev ? fixed(1000 * *q.noise_floor_stdev, 2) + " mm" : "not measured");
  Sheet sheet{begin(histogram_canvas, chart_stamps(study, std::move(subtitle))), histogram_canvas};
  Script& script = sheet.script;
  const std::vector<Bar> all = strip_bars(q);
  const Vec2 range = x_range(q, all);
  script("set xrange [", range.x, ":", range.y, "]");
  script("set xtics ", nice_step(range.y - range.x, 8));
  if (q.histogram.underflow > 0)
    text(script, histogram_canvas, bars.left + 8, bars.top + 8, std::to_string(q.histogram.underflow) + " below",
         Align::left, 9, false, faint);
  if (q.histogram.overflow > 0)
    text(script, histogram_canvas, bars.right - 8, bars.top + 8, std::to_string(q.histogram.overflow) + " above",
         Align::right, 9, false, faint);
  place(script, histogram_canvas, bars);
  draw_bars(script, q);
  place(script, histogram_canvas, strip);
  draw_strip(script, all);
  return sheet;
}

}  // namespace talus::figures

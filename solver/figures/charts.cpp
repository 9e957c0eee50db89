#include "figures/charts.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "support/measures.hpp"

namespace talus::figures {
namespace {

constexpr Panel chart_panel{84, 872, 84, 488};  // px, of a chart with one panel
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

using Rows = std::vector<std::array<double, 4>>;

// Smallest and largest value, and some room on either side.
Axis axis_over(std::span<const double> values, double room_if_equal, std::string_view label) {
  if (values.empty()) return {0, 1, 0.1, label};
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  const double room = *hi > *lo ? 0.06 * (*hi - *lo) : room_if_equal;
  return {*lo - room, *hi + room, nice_step(*hi - *lo + 2 * room, 8), label};
}

// A point of the exceedance curve that readers ask for; fewer than five runs beyond it say too little.
void mark_quantile(Script& script, const StudyFiles& study, double quantile, const char* name) {
  const Quantity& q = study.runout();
  const auto found = q.quantiles.find(quantile);
  if (found == q.quantiles.end() || (1.0 - quantile) * static_cast<double>(study.done) < 5 - 1e-9) return;
  const double x = found->second;
  const bool at_least = q.censored > 0 && x >= q.censored_from;
  script("set label ", literal(std::string(name) + (at_least ? ": at least " : ": ") + fixed(x, 2) + " m"), " at ", x,
         ",", 1.0 - quantile, " left offset 1.2,0.5 front point pointtype 7 pointsize 0.6 linecolor rgb '", vermillion,
         "' textcolor rgb '", ink, "'");
}

// n, mean, lower and upper end of the interval of the first n realizations done, at most some 300 times.
Rows running_means(const std::vector<Done>& realizations) {
  std::vector<double> sample;
  for (const Done& r : realizations) sample.push_back(r.influence_zone);
  const std::size_t stride = 1 + sample.size() / 300;
  Rows rows;
  for (std::size_t n = 1; n <= sample.size(); ++n) {
    if (n % stride != 0 && n != sample.size()) continue;
    const SampleMoments m = moments(std::span(sample).first(n));
    const Interval interval = m.mean_ci95.value_or(Interval{});
    rows.push_back({static_cast<double>(n), *m.mean, interval.lo.value_or(unknown), interval.hi.value_or(unknown)});
  }
  return rows;
}

// All means, and the intervals of eight and more realizations: those of fewer may leave the picture.
Axis means_axis(const Rows& rows) {
  std::vector<double> shown;
  for (const auto& [n, mean, lo, hi] : rows) {
    shown.push_back(mean);
    if (n >= std::min(8.0, rows.back()[0]) && lo == lo) shown.insert(shown.end(), {lo, hi});
  }
  return axis_over(shown, 0.1, "mean run-out distance of the farthest particle (m)");
}

}  // namespace

Sheet chart(const StudyFiles& study, std::string_view subtitle, const Canvas& canvas) {
  return {canvas,
          {study.title, std::string(subtitle), study.source + "  ·  " + count_text(study),
           shortened(study.quality, note_characters(canvas))}};
}

std::string count_text(const StudyFiles& study) {
  if (study.done == study.planned) return std::to_string(study.done) + " realizations";
  std::string text = std::to_string(study.done) + " of " + std::to_string(study.planned) + " realizations done";
  if (study.failed > 0) text += ", " + std::to_string(study.failed) + " failed";
  return text;
}

std::string interval_text(const std::optional<double>& value, const std::optional<Interval>& interval) {
  if (!value) return "unknown";
  std::string text = fixed(*value, 2);
  if (interval && interval->lo && interval->hi)
    text += " [" + fixed(*interval->lo, 2) + ", " + fixed(*interval->hi, 2) + "]";
  return text + " m";
}

std::string censored_text(const Quantity& q) {
  if (q.censored == 0) return "";
  return ". " + std::to_string(q.censored) + " runs left the terrain from " + fixed(q.censored_from, 2) +
         " m on and count as beyond it";
}

std::string means_text(const StudyFiles& study) {
  const auto mean = [](const char* label, const Quantity& q, const std::optional<Interval>& interval) {
    return label + std::string(q.censored > 0 ? " at least " : " ") + interval_text(q.mean, interval);
  };
  const auto leading = study.quantities.find(leading_measure.key);
  return (leading == study.quantities.end() ? "Mean: "
                                            : "Mean: " + mean(leading_measure.label, leading->second, {}) + ", ") +
         mean(measure_table[0].label, study.runout(), study.runout().mean_ci95);
}

Sheet exceedance_sheet(const StudyFiles& study) {
  Sheet sheet = chart(
      study, std::string("Probability that the farthest particle goes beyond x, given failure. Band: 95 % (Wilson)") +
                 (study.failed > 0 ? ", widened to allow for failed runs (none to all of them exceed x)" : "") +
                 censored_text(study.runout()));
  Rows rows;
  for (const Exceedance& e : study.runout().exceedance) rows.push_back({e.x, e.p, e.lo, e.hi});
  sheet.script.data("curve", rows);
  const double lo = rows.empty() ? 0.0 : rows.front()[0];
  const double hi = rows.empty() ? 1.0 : rows.back()[0];
  const double room = hi > lo ? 0.06 * (hi - lo) : 1.0;
  sheet.axes(
      {lo - room, hi + 3 * room, nice_step(hi - lo + 4 * room, 8), "run-out distance x of the farthest particle (m)"},
      {0, 1.02, 0.1, "probability of exceedance"});
  mark_quantile(sheet.script, study, 0.5, "half of the runs");
  mark_quantile(sheet.script, study, 0.9, "1 in 10");
  mark_quantile(sheet.script, study, 0.99, "1 in 100");
  sheet.place(chart_panel);
  sheet.script.plot(std::array{band("curve"), line("curve", blue)});
  return sheet;
}

Sheet running_mean_sheet(const StudyFiles& study) {
  Sheet sheet = chart(study, means_text(study) + "; drawn: the latter of n runs. Band: 95 %");
  const Rows rows = running_means(study.realizations);
  if (rows.empty()) return sheet;
  const auto [n, mean, lo, hi] = rows.back();
  sheet.script.data("means", rows).data("final", std::array{Vec2{0, mean}, Vec2{n, mean}});
  sheet.axes({0, 1.02 * std::max(2.0, n), std::max(1.0, nice_step(n, 8)), "realizations n"}, means_axis(rows));
  sheet.place(chart_panel);
  sheet.script.plot(std::array{band("means"), line("final", vermillion, 1, true), line("means", blue)});
  return sheet;
}

Sheet friction_angle_sheet(const StudyFiles& study) {
  std::vector<double> phi, runout;
  std::vector<Vec2> points;
  for (const Done& r : study.realizations) {
    phi.push_back(r.mean_phi_deg);
    runout.push_back(r.influence_zone);
    points.push_back({r.mean_phi_deg, r.influence_zone});
  }
  const std::optional<double> r = correlation(phi, runout);
  Sheet sheet = chart(study, r ? "Correlation " + fixed(*r, 2) + "; dashed: least squares" : "One point per run");
  const Axis x = axis_over(phi, 0.5, "mean friction angle of the slide (°)");
  sheet.axes(x, axis_over(runout, 0.5, "run-out distance of the farthest particle (m)"));
  sheet.place(chart_panel);
  sheet.script.data("runs", points);
  std::vector<std::string> elements{"$runs using 1:2 with points pointtype 7 pointsize 0.5 linecolor rgb '#660072B2'"};
  if (r) {
    // Least squares: y = mean(y) + r s_y / s_x (x - mean(x)).
    const SampleMoments mx = moments(phi), my = moments(runout);
    const auto fit = [&](double at) { return Vec2{at, *my.mean + *r * *my.stdev / *mx.stdev * (at - *mx.mean)}; };
    sheet.script.data("fit", std::array{fit(x.lo), fit(x.hi)});
    elements.push_back(line("fit", vermillion, 1.2, true));
  }
  sheet.script.plot(elements);
  return sheet;
}

Sheet spread_sheet(const StudyFiles& study) {
  constexpr Panel panel{190, 812, 104, 460};
  // The axis has one unit, that of the first measure.
  const auto on_axis = [](const Measure& m) { return std::string_view(m.unit) == measure_table[0].unit; };
  const auto measures = static_cast<double>(std::ranges::count_if(measure_table, on_axis));
  Sheet sheet = chart(study, "Standard deviation from soil variability, compared with the numerical noise", {900, 540});
  const auto legend = [&sheet](double x, const char* colour, const char* name) {
    sheet.text(x, 92, "■", {.colour = colour});
    sheet.text(x + 16, 92, name);
  };
  legend(panel.left, blue, "standard deviation, 95 % interval");
  legend(panel.left + 260, vermillion, "numerical noise");
  Rows spread, noise;  // length and interval of a bar, its height in the picture
  double widest = 0.0;
  double row = measures + 1.0;
  for (const Measure& measure : measure_table) {
    if (!on_axis(measure)) continue;
    row -= 1.0;
    const double y = panel.bottom - (row - 0.4) / (measures + 0.2) * panel.height();
    sheet.text(panel.left - 10, y, measure.label, {.align = Align::right});
    const auto found = study.quantities.find(measure.key);
    if (found == study.quantities.end()) continue;
    const Quantity& q = found->second;
    const Interval interval = q.stdev_ci95.value_or(Interval{});
    const double stdev = q.stdev.value_or(0.0), noise_stdev = q.noise_floor_stdev.value_or(0.0);
    spread.push_back(
        {q.stdev.value_or(unknown), interval.lo.value_or(unknown), interval.hi.value_or(unknown), row + 0.16});
    noise.push_back({q.noise_floor_stdev.value_or(unknown), unknown, unknown, row - 0.2});
    widest = std::max({widest, stdev, interval.hi.value_or(0.0), noise_stdev});
    sheet.text(sheet.canvas.width - 24, y,
               fixed(stdev, 3) + " / " + (q.noise_floor_stdev ? fixed(noise_stdev, 3) : std::string("–")),
               {.align = Align::right, .points = 9, .colour = faint});
  }
  if (widest <= 0.0) widest = 1.0;
  sheet.script.data("spread", spread).data("floor", noise);
  const std::string label = std::string("standard deviation over the realizations (") + measure_table[0].unit + ")";
  sheet.axes({0, 1.04 * widest, nice_step(widest, 6), label}, {0.4, measures + 0.6, 0, ""});
  sheet.script("set border 1");
  sheet.place(panel);
  sheet.script.plot(std::array{
      boxes("spread", "($1/2):4:(0):1:($4-0.16):($4+0.16)", 0.75, blue, "noborder"),
      std::string("$spread using 1:4:2:3 with xerrorbars pointtype 0 linewidth 1 linecolor rgb '") + ink + "'",
      boxes("floor", "($1/2):4:(0):1:($4-0.14):($4+0.14)", 0.9, vermillion,
            "border rgb '" + std::string(vermillion) + "'")});
  return sheet;
}

}  // namespace talus::figures

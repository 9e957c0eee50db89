#include <algorithm>
#include <array>
#include <cstdint>

#include "figures/charts.hpp"

namespace talus::figures {
namespace {

constexpr Panel upper{166, 872, 84, 420};
constexpr Panel strip{166, 872, 428, 532};

// What the strip beneath the histogram shows: lo to hi at the mean, at height `row`.
struct Bar {
  const char* name;
  double lo, hi;
  double row;
  const char* colour;
};

std::vector<Bar> strip_bars(const Quantity& q) {
  std::vector<Bar> all;
  const auto around_mean = [&](const char* name, const std::optional<double>& half, double row, const char* colour) {
    if (q.mean && half) all.push_back({name, *q.mean - *half, *q.mean + *half, row, colour});
  };
  if (q.mean_ci95 && q.mean_ci95->lo && q.mean_ci95->hi)
    all.push_back({"mean, 95 % interval", *q.mean_ci95->lo, *q.mean_ci95->hi, 3, vermillion});
  around_mean("± standard deviation", q.stdev, 2, blue);
  around_mean("± numerical noise", q.noise_floor_stdev, 1, faint);
  return all;
}

// Bins and strip, and half a bin to spare.
Axis x_axis(const Quantity& q, const std::vector<Bar>& bars) {
  double lo = q.mean.value_or(0.0);
  double hi = lo;
  if (const auto& edges = q.histogram.edges; !edges.empty()) {
    const double spare = 0.5 * (edges[1] - edges[0]);
    lo = edges.front() - spare;
    hi = edges.back() + spare;
  }
  for (const Bar& bar : bars) {
    lo = std::min(lo, bar.lo);
    hi = std::max(hi, bar.hi);
  }
  const double spare = hi > lo ? 0.0 : 1.0;
  return {lo - spare, hi + spare, nice_step(hi - lo + 2 * spare, 8), ""};
}

void draw_histogram(Sheet& sheet, const Quantity& q, const Axis& x) {
  const Histogram& h = q.histogram;
  std::vector<std::array<double, 3>> rows;
  double top = 1.0;
  for (std::size_t i = 0; i < h.counts.size(); ++i) {
    rows.push_back({h.edges[i], h.edges[i + 1], static_cast<double>(h.counts[i])});
    top = std::max(top, rows.back()[2]);
  }
  sheet.script.data("bins", rows);
  sheet.axes(x, {0, 1.08 * top, std::max(1.0, nice_step(top, 6)), "realizations"});
  sheet.script("set format x ''");
  const auto note = [&sheet](std::int64_t count, const char* where, double left, Align align) {
    if (count > 0)
      sheet.text(left, upper.top + 8, std::to_string(count) + where, {.align = align, .points = 9, .colour = faint});
  };
  note(h.underflow, " below", upper.left + 8, Align::left);
  note(h.overflow, " above", upper.right - 8, Align::right);
  sheet.place(upper);
  std::vector<std::string> elements{
      boxes("bins", "(0.5*($1+$2)):($3/2.0):1:2:(0):3", 0.75, blue, "border rgb '#ffffff'")};
  if (q.mean) {
    sheet.script.data("mean", std::array{Vec2{*q.mean, 0}, Vec2{*q.mean, 1.08 * top}});
    elements.push_back(line("mean", vermillion, 1.6));
  }
  sheet.script.plot(elements);
}

void draw_strip(Sheet& sheet, const std::vector<Bar>& bars, Axis x) {
  sheet.script("unset label");
  x.label = "run-out distance (m) of the farthest particle";
  sheet.axes(x, {0.4, 3.6, 0, ""});
  sheet.script("set border 1");
  sheet.script("set format x '%g'");
  sheet.place(strip);
  std::vector<std::string> elements;
  for (const Bar& bar : bars) {
    const std::string name = "strip" + number(bar.row);
    sheet.script.data(name, std::array<std::array<double, 3>, 1>{{{bar.lo, bar.hi, bar.row}}});
    sheet.text(strip.left - 10, strip.bottom - (bar.row - 0.4) / 3.2 * strip.height(), bar.name,
               {.align = Align::right, .colour = bar.colour});
    elements.push_back(boxes(name, "(0.5*($1+$2)):3:1:2:($3-0.25):($3+0.25)", 0.9, bar.colour,
                             "border rgb '" + std::string(bar.colour) + "'"));
  }
  sheet.script.plot(elements);
}

}  // namespace

Sheet histogram_sheet(const StudyFiles& study) {
  const Quantity& q = study.runout();
  // The strip shows the standard deviation and the noise too, should there be no room to state them.
  const std::string spread =
      ", standard deviation " + interval_text(q.stdev, {}) + ", noise " +
      (q.noise_floor_stdev ? fixed(1000 * *q.noise_floor_stdev, 2) + " mm" : std::string("not measured"));
  Sheet sheet = chart(study, means_text(study) + (q.censored > 0 ? censored_text(q) : spread), {900, 616});
  const std::vector<Bar> bars = strip_bars(q);
  const Axis x = x_axis(q, bars);
  draw_histogram(sheet, q, x);
  draw_strip(sheet, bars, x);
  return sheet;
}

}  // namespace talus::figures

#include "figures/energy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace talus::figures {
namespace {

constexpr Canvas canvas_without_note{900, 558};
constexpr Panel panel_without_note{84, 640, 66, 482};
constexpr double least_share = 0.005;  ///< of gravity's work, for a line of its own

/// A line of the chart.
struct Curve {
  const char* name;
  const char* colour;
  bool dashed;
  double (*value)(const EnergyBudget&);
};

// Colours of Okabe and Ito.
constexpr Curve curves[] = {
    {"work of gravity", ink, true, [](const EnergyBudget& e) { return e.gravity_work(); }},
    {"friction", blue, false, [](const EnergyBudget& e) { return e.friction; }},
    {"viscosity", "#56B4E9", false, [](const EnergyBudget& e) { return e.viscosity; }},
    {"artificial viscosity", "#E69F00", false, [](const EnergyBudget& e) { return e.artificial_viscosity; }},
    {"density diffusion", "#CC79A7", false, [](const EnergyBudget& e) { return e.density_diffusion; }},
    {"boundaries", "#7F7F7F", false, [](const EnergyBudget& e) { return e.boundaries; }},
    {"ground contact", "#7F7F7F", true, [](const EnergyBudget& e) { return e.contact; }},
    {"departed", "#009E73", true, [](const EnergyBudget& e) { return e.departed; }},
    {"kinetic", "#009E73", false, [](const EnergyBudget& e) { return e.kinetic; }},
    {"elastic", "#CC79A7", true,
     [](const EnergyBudget& e) { return e.compression + e.distortion - e.stored_at_start; }},
    {"not explained", vermillion, false, [](const EnergyBudget& e) { return e.created(); }},
};

/// A power of 1,000 with which the largest value is at least 1, and the unit that belongs to it.
struct Unit {
  double joules;
  const char* label;
};
Unit unit_for(double largest) {
  for (const Unit unit : {Unit{1e9, "energy (GJ/m)"}, Unit{1e6, "energy (MJ/m)"}, Unit{1e3, "energy (kJ/m)"}})
    if (largest >= unit.joules) return unit;
  return {1.0, "energy (J/m)"};
}

std::string per_cent(double part, double whole) {
  if (!(whole > 0.0)) return "–";
  const double hundredths = std::round(1e4 * part / whole) + 0.0;  // no minus before zero
  return fixed(0.01 * hundredths, 2) + " %";
}

}  // namespace

Sheet energy_sheet(std::span<const HistoryRow> history, const Stamps& stamps) {
  const EnergyBudget& end = history.back().energy;
  const double gravity = end.gravity_work();
  Stamps with_subtitle = stamps;
  with_subtitle.subtitle = "Work of gravity per metre of width, and what took it";
  const double note_height = note_pitch * static_cast<double>(note_lines(stamps.note, canvas_without_note).size());
  const double room_above = std::max(note_pitch, note_height);
  const Canvas canvas{canvas_without_note.width, canvas_without_note.height + room_above};
  Panel panel = panel_without_note;
  panel.top += room_above;
  panel.bottom += room_above;
  Sheet sheet(canvas, with_subtitle);
  double largest = 0.0, lowest = 0.0, highest = 0.0;
  for (const HistoryRow& row : history) largest = std::max(largest, std::abs(row.energy.gravity_work()));
  const Unit unit = unit_for(largest);
  std::vector<std::string> lines;
  double y = panel.top + 8;
  sheet.text(panel.right + 24, y, "at the end, of gravity's work", {.points = 9, .colour = faint});
  for (const Curve& curve : curves) {
    std::vector<Vec2> points;
    double extent = 0.0;
    for (const HistoryRow& row : history) {
      const double value = curve.value(row.energy);
      points.push_back({row.time, value / unit.joules});
      extent = std::max(extent, std::abs(value));
    }
    const bool drawn = extent >= least_share * largest;
    y += 24;
    sheet.text(panel.right + 24, y, curve.dashed ? "╍" : "━", {.bold = true, .colour = drawn ? curve.colour : grid});
    sheet.text(panel.right + 46, y, curve.name, {.colour = drawn ? ink : faint});
    sheet.text(canvas.width - 24, y, per_cent(curve.value(end), gravity),
               {.align = Align::right, .colour = drawn ? ink : faint});
    if (!drawn) continue;
    for (const Vec2& p : points) {
      lowest = std::min(lowest, p.y);
      highest = std::max(highest, p.y);
    }
    const std::string name = "curve" + std::to_string(lines.size());
    sheet.script.data(name, points);
    lines.push_back(line(name, curve.colour, 2, curve.dashed));
  }
  const double room = highest > lowest ? 0.04 * (highest - lowest) : 1.0, time = std::max(history.back().time, 1e-9);
  sheet.axes({0, 1.02 * time, nice_step(time, 8), "time (s)"},
             {lowest < 0 ? lowest - room : 0, highest + room, nice_step(highest - lowest + room, 8), unit.label});
  sheet.place(panel);
  sheet.script.plot(lines);
  return sheet;
}

}  // namespace talus::figures

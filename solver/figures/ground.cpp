#include "figures/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "figures/colour.hpp"

namespace talus::figures {
namespace {

Vec2 at_x(Vec2 a, Vec2 b, double x) { return a + ((x - a.x) / (b.x - a.x)) * (b - a); }

}  // namespace

std::vector<Vec2> clipped(const std::vector<Vec2>& line, double lo, double hi) {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec2 a = line[i], b = line[i + 1];
    if (std::max(a.x, b.x) < lo || std::min(a.x, b.x) > hi) continue;
    for (const Vec2 end : {a, b}) {
      const Vec2 cut = end.x < lo ? at_x(a, b, lo) : end.x > hi ? at_x(a, b, hi) : end;
      if (out.empty() || !(out.back() == cut)) out.push_back(cut);
    }
  }
  return out;
}

std::vector<Vec2> visible_part(const Polyline& line, double lo, double hi) {
  if (!line.closed) return clipped(line.vertices, lo, hi);
  std::vector<Vec2> ring = line.vertices;
  ring.push_back(ring.front());
  return ring;
}

std::vector<Stroke> hatching(const std::vector<Vec2>& line, double spacing, double length) {
  std::vector<Stroke> strokes;
  double next = spacing;  // distance from the start of the segment to the next stroke
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec2 step = line[i + 1] - line[i];
    const double reach = norm(step);
    if (reach == 0.0) continue;
    const Vec2 t = (1.0 / reach) * step;
    const Vec2 right{t.y, -t.x};
    for (; next <= reach; next += spacing)
      strokes.push_back({line[i] + next * t, (length / std::sqrt(2.0)) * (right - t)});
    next -= reach;
  }
  return strokes;
}

GroundElements ground_elements(Script& script, const Polyline& bed, const Box& view, double metre,
                               const std::string& tag, double width) {
  const std::vector<Vec2> surface = visible_part(bed, view.lo.x, view.hi.x);
  if (surface.size() < 2) return {};
  GroundElements elements;
  if (!bed.closed) {
    std::vector<Vec2> rock = surface;
    rock.insert(rock.end(), {{rock.back().x, view.lo.y}, {rock.front().x, view.lo.y}});
    script.data("rock" + tag, rock);
    elements.behind.push_back("$rock" + tag + " using 1:2 with filledcurves closed fillcolor rgb '" + ground + "'");
  }
  std::vector<std::array<double, 4>> strokes;
  for (const Stroke& s : hatching(surface, 9 / metre, 8 / metre))
    strokes.push_back({s.from.x, s.from.y, s.along.x, s.along.y});
  script.data("ground" + tag, surface).data("hatch" + tag, strokes);
  elements.front = {"$hatch" + tag + " using 1:2:3:4 with vectors nohead linewidth 0.6 linecolor rgb '" + faint + "'",
                    line("ground" + tag, ink, width)};
  return elements;
}

std::vector<Polyline> structures_of(const Model& model) {
  std::vector<Polyline> structures;
  for (std::size_t b = 1; b < model.boundaries.size(); ++b) structures.push_back(model.boundaries[b].line);
  return structures;
}

std::vector<std::string> structure_elements(Script& script, const std::vector<Polyline>& structures,
                                            const std::string& tag) {
  std::vector<std::string> elements;
  for (std::size_t k = 0; k < structures.size(); ++k) {
    const std::string name = "structure" + std::to_string(k) + tag;
    script.data(name, structures[k].vertices);
    elements.push_back("$" + name +
                       " using 1:2 with filledcurves closed fillcolor rgb '#8A8A8A' fillstyle solid border rgb '" +
                       ink + "'");
  }
  return elements;
}

std::string slide_element(Script& script, const std::string& name, const std::vector<Vec2>& outline,
                          const char* colour) {
  script.data(name, outline);
  return "$" + name + " using 1:2 with filledcurves closed fillcolor rgb '" + colour +
         "' fillstyle solid border rgb '#8A7556'";
}

}  // namespace talus::figures

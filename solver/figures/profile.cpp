#include "figures/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "case/outline.hpp"
#include "figures/ground.hpp"
#include "figures/raster.hpp"
#include "particles/geometry.hpp"

namespace talus::figures {
namespace {

constexpr std::size_t many = 200'000;  // particles that are faster drawn as an image
constexpr double disk_radius =
    std::numbers::sqrt2 / 2;  // of dx: the circle around a particle's square, so that no holes show at rest

struct Drawing {
  Sheet& sheet;
  const Layout& layout;
  const Terrain& terrain;
  double dx;
  Box view;
  bool raster;
};

// Plot elements of the soil, with the bytes that must follow the plot command.
struct SoilElements {
  std::vector<std::string> elements;
  std::string bytes;
};

SoilElements soil_image(const Drawing& d, const Snapshot& shot, ColourRange range) {
  const ColourScale& scale = scale_of(shot.colour);
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < shot.frame->n_soil; ++i) {
    const double t = (scale.value(*shot.frame, i) - range.lo) / (range.hi - range.lo);
    disks.push_back({shot.frame->position[i], colour_at(*scale.palette, t)});
  }
  Image image = disk_image(disks, disk_radius * d.dx, std::max(0.5 / d.layout.metre, d.dx / 6));
  const std::string pixel = number(image.pixel);
  // The second element draws no point; the colour bar needs it.
  return {{"'-' binary array=(" + std::to_string(image.columns) + "," + std::to_string(image.rows) +
               ") format='%uchar%uchar%uchar%uchar' origin=(" + number(image.first.x) + "," + number(image.first.y) +
               ") dx=" + pixel + " dy=" + pixel + " using 1:2:3:4 with rgbalpha",
           "'+' using (" + number(d.view.lo.x) + "):(NaN):(" + number(range.lo) + ") with points palette"},
          std::move(image.rgba)};
}

SoilElements soil_disks(const Drawing& d, const Snapshot& shot, const std::string& tag) {
  const Frame& frame = *shot.frame;
  std::vector<std::array<double, 3>> rows;
  for (std::size_t i = 0; i < frame.n_soil; ++i)
    rows.push_back({frame.position[i].x, frame.position[i].y, scale_of(shot.colour).value(frame, i)});
  d.sheet.script.data("soil" + tag, rows);
  return {{"$soil" + tag + " using 1:2:(" + number(disk_radius * d.dx) +
           "):3 with circles fillstyle solid noborder linecolor palette"},
          {}};
}

// A dashed line at the farthest particle, up to just above the soil there.
std::string front_element(const Drawing& d, const Frame& frame, const std::string& tag) {
  const std::span<const Vec2> soil = std::span(frame.position).first(frame.n_soil);
  const RunOutAxis& axis = d.terrain.run_out;
  const Vec2 front = *std::ranges::max_element(soil, {}, [&](Vec2 p) { return axis.distance(p.x); });
  const double reach = 52 / d.layout.metre;
  double top = front.y;
  for (const Vec2 p : soil)
    if (std::abs(p.x - front.x) < reach) top = std::max(top, p.y);
  top = std::min(top + 12 / d.layout.metre, d.view.hi.y - 14 / d.layout.metre);
  const double bottom = d.terrain.closed || d.terrain.bed.empty() ? front.y : height_beneath(d.terrain.bed, front);
  d.sheet.script.data("front" + tag, std::array{Vec2{front.x, bottom}, Vec2{front.x, top}});
  d.sheet.script("set label ", literal("front " + fixed(axis.distance(front.x), 2) + " m"), " at ", front.x, ",", top,
                 " center offset 0,0.7 front font 'sans-serif:Bold,10' textcolor rgb '", vermillion, "'");
  return line("front" + tag, vermillion, 1.2, true);
}

// White dots with a dark ring, and their texts, which stay in the panel.
std::string mark_element(const Drawing& d, const std::vector<Mark>& marks, const std::string& tag) {
  std::vector<Vec2> points;
  for (const Mark& mark : marks) {
    points.push_back(mark.at);
    const bool left = mark.at.x > d.view.lo.x + 0.8 * d.view.width();
    d.sheet.script("set label ", literal(mark.text), " at ", mark.at.x, ",", mark.at.y, left ? " right" : " left",
                   " offset ", left ? -0.8 : 0.8, ",0 front boxed font 'sans-serif:Bold,9' textcolor rgb '", ink, "'");
  }
  d.sheet.script("set style textbox opaque noborder fillcolor rgb 'white' margins 0.4,0.4");
  d.sheet.script.data("marks" + tag, points);
  return "$marks" + tag + " with points pointtype 7 pointsize 1.1 linecolor rgb '" + ink + "', $marks" + tag +
         " with points pointtype 7 pointsize 0.6 linecolor rgb 'white'";
}

void colour_axis(Script& script, Colour colour, ColourRange range) {
  script(palette_command(*scale_of(colour).palette));
  script("set cbrange [", range.lo, ":", range.hi, "]");
  script("set cbtics ", nice_step(range.hi - range.lo, 4));
}

void panel_plot(const Drawing& d, std::size_t k, const Snapshot& shot, ColourRange range,
                const ProfileOptions& options) {
  const Panel& panel = d.layout.panels[k];
  const std::string tag = std::to_string(k);
  d.sheet.place(panel);
  d.sheet.axes(
      {d.view.lo.x, d.view.hi.x, nice_step(d.view.width(), panel.width(), 90), axis_label("x", d.terrain.origin.x)},
      {d.view.lo.y, d.view.hi.y, nice_step(d.view.height(), panel.height(), 50), axis_label("y", d.terrain.origin.y)});
  d.sheet.script("set xlabel offset 0,0.4");
  d.sheet.script("set ylabel offset 0.8,0");
  const std::string caption = shot.caption.empty() ? "t = " + fixed(shot.frame->time, 2) + " s" : shot.caption;
  d.sheet.text(panel.left, panel.top - 12, caption, {.points = 11, .bold = true});
  const GroundElements bed = ground_elements(d.sheet.script, ground_line(d.terrain), d.view, d.layout.metre, tag);
  std::vector<std::string> elements = structure_elements(d.sheet.script, options.structures, tag);
  elements.insert(elements.end(), bed.behind.begin(), bed.behind.end());
  std::string bytes;
  if (shot.frame->n_soil > 0) {
    SoilElements soil = d.raster ? soil_image(d, shot, range) : soil_disks(d, shot, tag);
    elements.insert(elements.end(), soil.elements.begin(), soil.elements.end());
    bytes = std::move(soil.bytes);
  }
  elements.insert(elements.end(), bed.front.begin(), bed.front.end());
  if (!options.marks.empty()) elements.push_back(mark_element(d, options.marks, tag));
  if (options.mark_front && shot.frame->n_soil > 0) elements.push_back(front_element(d, *shot.frame, tag));
  d.sheet.script.plot(elements, bytes);
  d.sheet.script("unset label");
  d.sheet.script("unset colorbox");
}

/// `height` px more above the panels.
void make_room(Layout& layout, double height) {
  layout.canvas.height += height;
  for (Panel& panel : layout.panels) {
    panel.top += height;
    panel.bottom += height;
  }
}

std::vector<const Frame*> frames_of(std::span<const Snapshot> snapshots, std::optional<Colour> colour = {}) {
  std::vector<const Frame*> frames;
  for (const Snapshot& s : snapshots) {
    if (!colour || s.colour == *colour) frames.push_back(s.frame);
  }
  return frames;
}

}  // namespace

Box view_of(std::span<const Frame* const> frames, const Terrain& terrain, double dx) {
  Box box{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Frame* frame : frames)
    for (std::size_t i = 0; i < frame->n_soil; ++i) box.include(frame->position[i]);
  if (terrain.closed || box.lo.x > box.hi.x)
    for (const Vec2 p : terrain.bed) box.include(p);
  const double margin = 0.03 * box.width() + dx;
  const bool to_right = terrain.run_out.to == SlidesTo::right;
  box.lo.x = (to_right ? std::min(box.lo.x, terrain.run_out.from) : box.lo.x - 2 * margin) - margin;
  box.hi.x = (to_right ? box.hi.x + 2 * margin : std::max(box.hi.x, terrain.run_out.from)) + margin;
  if (!terrain.closed && !terrain.bed.empty()) {
    // Soil that fell off an open end does not stretch the picture.
    if (to_right)
      box.hi.x = std::min(box.hi.x, terrain.bed.back().x + margin);
    else
      box.lo.x = std::max(box.lo.x, terrain.bed.front().x - margin);
    box.lo.y = 1e300;
    for (const Vec2 p : clipped(terrain.bed, box.lo.x, box.hi.x)) box.lo.y = std::min(box.lo.y, p.y);
  }
  const double height = std::max({box.height(), 0.12 * box.width(), 4 * dx});
  box.hi.y = box.lo.y + 1.1 * height;
  box.lo.y -= 0.08 * height + 0.012 * box.width();
  return box;
}

Layout profile_layout(std::size_t n, const Box& view, double caption) {
  constexpr double header = 68;        // px: title and subtitle
  constexpr double footer = 34;        // px: source line
  constexpr double left = 62;          // px: y tics and label of each panel
  constexpr double right = 24;         // px
  constexpr double beneath = 46;       // px: x tics and label of each panel
  constexpr double tallest = 440;      // px, of one panel
  constexpr double narrowest = 760;    // px, so that title and colour bar find room
  constexpr double tall_sheet = 1250;  // px: more columns rather than a taller sheet
  Layout layout;
  for (std::size_t columns = 1; columns <= 4; ++columns) {
    layout.canvas.width = columns == 1 ? 1040 : 1320;
    const double widest = layout.canvas.width / static_cast<double>(columns) - left - right;
    layout.metre = std::min(widest / view.width(), tallest / view.height());
    const double width = layout.metre * view.width();
    const double height = layout.metre * view.height();
    const std::size_t rows = (n + columns - 1) / columns;
    const double pitch = caption + height + beneath;
    layout.canvas.height = std::round(header + static_cast<double>(rows) * pitch + footer);
    layout.panels.clear();
    for (std::size_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(k % columns) * (left + width + right) + left;
      const double y = header + static_cast<double>(k / columns) * pitch + caption;
      layout.panels.push_back({x, x + width, y, y + height});
    }
    layout.canvas.width = std::max(narrowest, std::round(layout.panels[std::min(n, columns) - 1].right + right));
    if (layout.canvas.height <= tall_sheet) break;
  }
  return layout;
}

Sheet profile_sheet(std::span<const Snapshot> snapshots, const Terrain& terrain, double dx, const Stamps& stamps,
                    const ProfileOptions& options, bool raster) {
  const std::vector<const Frame*> frames = frames_of(snapshots);
  const bool mixed = std::any_of(snapshots.begin(), snapshots.end(),
                                 [&](const Snapshot& s) { return s.colour != snapshots[0].colour; });
  const Box view = options.view.value_or(view_of(frames, terrain, dx));
  Layout layout = profile_layout(snapshots.size(), view, mixed ? 44 : 30);
  make_room(layout, note_pitch * static_cast<double>(note_lines(stamps.note, layout.canvas).size()));
  const double bar = 220;  // px
  Sheet sheet(layout.canvas, stamps, mixed ? 0 : bar + 170);
  const Drawing drawing{sheet, layout, terrain, dx, view, raster};
  for (std::size_t k = 0; k < snapshots.size(); ++k) {
    const Colour colour = snapshots[k].colour;
    const ColourRange range = rounded(options.range.value_or(value_range(frames_of(snapshots, colour), colour)));
    const double bar_right = mixed ? layout.panels[k].right : layout.canvas.width - 40;
    const double top = mixed ? layout.panels[k].top - 34 : 14;
    if (mixed || k == 0) sheet.colour_bar({bar_right - bar, bar_right, top, top + 10}, scale_of(colour).name);
    colour_axis(sheet.script, colour, range);
    panel_plot(drawing, k, snapshots[k], range, options);
  }
  return sheet;
}

void plot_profiles(std::span<const Snapshot> snapshots, const Terrain& terrain, double dx,
                   const std::filesystem::path& path, const Stamps& stamps, const ProfileOptions& options) {
  std::size_t particles = 0;
  for (const Snapshot& s : snapshots) particles += s.frame->n_soil;
  const bool raster = path.extension() == ".svg" || particles > many;
  profile_sheet(snapshots, terrain, dx, stamps, options, raster).save(path);
}

}  // namespace talus::figures

#include "figures/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "figures/ground.hpp"
#include "figures/layout.hpp"
#include "figures/raster.hpp"

namespace talus::figures {
namespace {

constexpr std::size_t many = 200'000;  // particles that are faster drawn as an image
constexpr double disk_radius =
    std::numbers::sqrt2 / 2;  // of dx: the circle around a particle's square, so that no holes show at rest

// Index of the farthest soil particle.
std::size_t farthest(const Frame& frame) {
  std::size_t far = 0;
  for (std::size_t i = 1; i < frame.n_soil; ++i) {
    if (frame.position[i].x > frame.position[far].x) far = i;
  }
  return far;
}

struct Drawing {
  Script& script;
  const Layout& layout;
  const Terrain& terrain;
  double dx;
  Box view;
  bool raster;
};

// Plot element of the soil, with the bytes that must follow the plot command.
struct SoilElement {
  std::string element;
  std::string bytes;
};

SoilElement soil_image(const Drawing& d, const Snapshot& shot, ColourRange range) {
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < shot.frame->n_soil; ++i) {
    const double t = (colour_value(*shot.frame, i, shot.colour) - range.lo) / (range.hi - range.lo);
    disks.push_back({shot.frame->position[i], colour_at(palette_of(shot.colour), t)});
  }
  Image image = disk_image(disks, disk_radius * d.dx, std::max(0.5 / d.layout.metre, d.dx / 6));
  Script element;
  // The second element draws nothing: it only brings the colour bar.
  element("'-' binary array=(", image.columns, ",", image.rows, ") format='%uchar%uchar%uchar%uchar' origin=(",
          image.first.x, ",", image.first.y, ") dx=", image.pixel, " dy=", image.pixel,
          " using 1:2:3:4 with rgbalpha, \\");
  element("  '+' using (", d.view.lo.x, "):(NaN):(", range.lo, ") with points palette, \\");
  return {element.text() + "  ", std::move(image.rgba)};
}

SoilElement soil_disks(const Drawing& d, const Snapshot& shot, const std::string& tag) {
  const Frame& frame = *shot.frame;
  std::vector<std::array<double, 3>> rows;
  for (std::size_t i = 0; i < frame.n_soil; ++i) {
    rows.push_back({frame.position[i].x, frame.position[i].y, colour_value(frame, i, shot.colour)});
  }
  d.script.data("soil" + tag, rows);
  return {"$soil" + tag + " using 1:2:(" + number(disk_radius * d.dx) +
              "):3 with circles fillstyle solid noborder linecolor palette, \\\n  ",
          {}};
}

// A dashed line at the farthest particle, up to just above the soil there.
std::string front_element(const Drawing& d, const Frame& frame, const std::string& tag) {
  const Vec2 front = frame.position[farthest(frame)];
  const double reach = 52 / d.layout.metre;
  double top = front.y;
  for (std::size_t i = 0; i < frame.n_soil; ++i) {
    if (std::abs(frame.position[i].x - front.x) < reach) top = std::max(top, frame.position[i].y);
  }
  top = std::min(top + 12 / d.layout.metre, d.view.hi.y - 14 / d.layout.metre);
  const double bottom = d.terrain.closed || d.terrain.bed.empty() ? front.y : bed_height(d.terrain, front.x);
  d.script.data("front" + tag, std::array<Vec2, 2>{Vec2{front.x, bottom}, Vec2{front.x, top}});
  const std::string words = "front " + fixed(front.x - d.terrain.left_boundary, 2) + " m";
  d.script("set label ", literal(words), " at ", front.x, ",", top,
           " center offset 0,0.7 front font 'sans-serif:Bold,10' textcolor rgb '", vermillion, "'");
  return "$front" + tag + " using 1:2 with lines dashtype 2 linewidth 1.2 linecolor rgb '" + vermillion + "', \\\n  ";
}

void axes(const Drawing& d, const Panel& panel) {
  place(d.script, d.layout.canvas, panel);
  d.script("set xrange [", d.view.lo.x, ":", d.view.hi.x, "]");
  d.script("set yrange [", d.view.lo.y, ":", d.view.hi.y, "]");
  d.script("set xtics ", nice_step(d.view.width(), std::max(2, static_cast<int>(panel.width() / 90))));
  d.script("set ytics ", nice_step(d.view.height(), std::max(2, static_cast<int>(panel.height() / 50))));
  d.script("set xlabel 'x (m)' offset 0,0.4");
  d.script("set ylabel 'y (m)' offset 0.8,0");
}

void colour_axis(Script& script, Colour colour, ColourRange range) {
  script(palette_command(palette_of(colour)));
  script("set cbrange [", range.lo, ":", range.hi, "]");
  script("set cbtics ", nice_step(range.hi - range.lo, 4));
}

void panel_plot(const Drawing& d, std::size_t k, const Snapshot& shot, ColourRange range, bool mark_front) {
  const Panel& panel = d.layout.panels[k];
  const std::string tag = std::to_string(k);
  axes(d, panel);
  const std::string caption = shot.caption.empty() ? "t = " + fixed(shot.frame->time, 2) + " s" : shot.caption;
  text(d.script, d.layout.canvas, panel.left, panel.top - 12, caption, Align::left, 11, true);
  const GroundElements bed = ground_elements(d.script, d.terrain, d.view, d.layout.metre, tag);
  SoilElement soil;
  std::string front;
  if (shot.frame->n_soil > 0) {
    soil = d.raster ? soil_image(d, shot, range) : soil_disks(d, shot, tag);
    if (mark_front) front = front_element(d, *shot.frame, tag);
  }
  d.script("plot ", bed.behind, soil.element, bed.front, front, "NaN").inline_binary(soil.bytes);
  d.script("unset label");
  d.script("unset colorbox");
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
  const auto include = [&box](Vec2 p) {
    box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)};
    box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)};
  };
  for (const Frame* frame : frames) {
    for (std::size_t i = 0; i < frame->n_soil; ++i) include(frame->position[i]);
  }
  if (terrain.closed) {
    for (const Vec2 p : terrain.bed) include(p);
  }
  if (box.lo.x > box.hi.x) {
    for (const Vec2 p : terrain.bed) include(p);
  }
  const double margin = 0.03 * box.width() + dx;
  box.lo.x = std::min(box.lo.x, terrain.left_boundary) - margin;
  box.hi.x += 3 * margin;
  if (!terrain.closed && !terrain.bed.empty()) {
    // Soil that fell off an open end does not stretch the picture.
    box.hi.x = std::min(box.hi.x, terrain.bed.back().x + margin);
    box.lo.y = 1e300;
    for (const Vec2 p : boundary(terrain, box.lo.x, box.hi.x)) box.lo.y = std::min(box.lo.y, p.y);
  }
  const double height = std::max({box.height(), 0.12 * box.width(), 4 * dx});
  box.hi.y = box.lo.y + 1.1 * height;
  box.lo.y -= 0.08 * height + 0.012 * box.width();
  return box;
}

Sheet profile_sheet(std::span<const Snapshot> snapshots, const Terrain& terrain, double dx, const Stamps& stamps,
                    const ProfileOptions& options, bool raster) {
  const std::vector<const Frame*> frames = frames_of(snapshots);
  const bool mixed = std::any_of(snapshots.begin(), snapshots.end(),
                                 [&](const Snapshot& s) { return s.colour != snapshots[0].colour; });
  const Box view = options.view.value_or(view_of(frames, terrain, dx));
  const Layout layout = profile_layout(snapshots.size(), view, mixed ? 44 : 30);
  const double bar = 220;  // px
  Sheet sheet{begin(layout.canvas, stamps, mixed ? 0 : bar + 170), layout.canvas};
  const Drawing drawing{sheet.script, layout, terrain, dx, view, raster};
  for (std::size_t k = 0; k < snapshots.size(); ++k) {
    const Colour colour = snapshots[k].colour;
    const ColourRange range = rounded(options.range.value_or(value_range(frames_of(snapshots, colour), colour)));
    const double right = mixed ? layout.panels[k].right : layout.canvas.width - 40;
    const double top = mixed ? layout.panels[k].top - 34 : 14;
    if (mixed || k == 0)
      colour_bar(sheet.script, layout.canvas, {right - bar, right, top, top + 10}, colour_name(colour));
    colour_axis(sheet.script, colour, range);
    panel_plot(drawing, k, snapshots[k], range, options.mark_front);
  }
  return sheet;
}

void plot_sequence(std::span<const Snapshot> snapshots, const Terrain& terrain, double dx,
                   const std::filesystem::path& path, const Stamps& stamps, const ProfileOptions& options) {
  std::size_t particles = 0;
  for (const Snapshot& s : snapshots) particles += s.frame->n_soil;
  const bool raster = path.extension() == ".svg" || particles > many;
  profile_sheet(snapshots, terrain, dx, stamps, options, raster).save(path);
}

void plot_profile(const Frame& frame, const Terrain& terrain, double dx, Colour colour,
                  const std::filesystem::path& path, const Stamps& stamps, const ProfileOptions& options) {
  plot_sequence(std::array{Snapshot{&frame, colour, {}}}, terrain, dx, path, stamps, options);
}

}  // namespace talus::figures

#pragma once
// Pictures of the slide in section, particles in their true size: one, or a sequence of small multiples like [Z20]
// Figs. 10, 11.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "figures/sheet.hpp"
#include "particles/geometry_input.hpp"
#include "simulation/frame.hpp"

namespace talus::figures {

/// One picture of a sequence.
struct Snapshot {
  const Frame* frame;
  Colour colour;
  std::string caption;  ///< "t = 2.25 s" if empty
};

/// A point with a text beside it, such as a measured value.
struct Mark {
  Vec2 at;  ///< [m]
  std::string text;
};

struct ProfileOptions {
  bool mark_front = true;              ///< a dashed line and the run-out at the farthest particle
  std::optional<ColourRange> range{};  ///< for all snapshots; unset: from the snapshots of the same colour
  std::vector<Mark> marks{};           ///< in every panel
  std::vector<Polyline> structures{};  ///< outlines of structures, drawn behind the ground
  std::optional<Box> view{};           ///< what is shown [m]; unset: the soil of all snapshots and some terrain ahead
};

/// The soil of all frames and some terrain ahead of it. [m]
Box view_of(std::span<const Frame* const> frames, const Terrain& terrain, double dx);

/// Panels of equal size, row by row, on a canvas made for them.
struct Layout {
  Canvas canvas;
  std::vector<Panel> panels;
  double metre;  ///< px per metre, the same in x and y
};

/// Where the panels of a sequence of profiles go: equal aspect, as large as fits.
/// @param n        panels, >= 1
/// @param view     what each shows [m]
/// @param caption  height of the caption row above each [px]
Layout profile_layout(std::size_t n, const Box& view, double caption);

/// The snapshots as panels of one figure with one scale and one colour scale a quantity.
/// @param dx      particle spacing [m]; a particle is a disk around its square of edge dx
/// @param raster  draw the soil as an image instead of disks, for an .svg of many particles
Sheet profile_sheet(std::span<const Snapshot> snapshots, const Terrain& terrain, double dx, const Stamps& stamps,
                    const ProfileOptions& options = {}, bool raster = false);

/// The same, drawn to .svg or .png; an .svg gets the soil as an embedded image: as thousands of circles it would take
/// megabytes.
/// @throws IoError when gnuplot is missing or fails, or the file cannot be written
void plot_profiles(std::span<const Snapshot> snapshots, const Terrain& terrain, double dx,
                   const std::filesystem::path& path, const Stamps& stamps, const ProfileOptions& options = {});

}  // namespace talus::figures

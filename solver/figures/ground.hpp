#pragma once
// The ground in a picture: bed line, hatching, fill.

#include <vector>

#include "figures/sheet.hpp"
#include "particles/geometry_input.hpp"

namespace talus::figures {

/// Part of an open polyline with x in [lo, hi], cut exactly at both; where it leaves and returns it is joined along the
/// cut. [m]
std::vector<Vec2> clipped(const std::vector<Vec2>& line, double lo, double hi);

/// The boundary as one line with the soil on its left: end walls and bed, or the whole ring. [m]
std::vector<Vec2> boundary(const Terrain& terrain, double lo, double hi);

/// A short stroke behind the boundary, as geotechnical drawings mark ground.
struct Stroke {
  Vec2 from;   ///< on the line [m]
  Vec2 along;  ///< [m]
};

/// Strokes every `spacing` along `line`, of length `length`, on its right side and leaning back by 45 degrees.
std::vector<Stroke> hatching(const std::vector<Vec2>& line, double spacing, double length);

/// Plot elements of the ground, and the data of them in the script.
struct GroundElements {
  std::vector<std::string> behind;  ///< fill, to be plotted before the soil
  std::vector<std::string> front;   ///< line and hatching, after it
};
/// The ground within `view`; `metre` is px per metre. Datablocks are named with `tag` so that several panels can live
/// in one script.
GroundElements ground_elements(Script& script, const Terrain& terrain, const Box& view, double metre,
                               const std::string& tag);

}  // namespace talus::figures

#pragma once
// The section in a picture: ground with hatching and fill, and the slide before failure.

#include <vector>

#include "figures/sheet.hpp"
#include "particles/geometry_input.hpp"
#include "simulation/model.hpp"

namespace talus::figures {

/// Part of an open polyline with x in [lo, hi], cut exactly at both; where it leaves and returns it is joined along the
/// cut. [m]
std::vector<Vec2> clipped(const std::vector<Vec2>& line, double lo, double hi);

/// An open line clipped to [lo, hi], or a whole ring with its first vertex repeated. [m]
std::vector<Vec2> visible_part(const Polyline& line, double lo, double hi);

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
  std::vector<std::string> front;   ///< hatching and, last, the line; after the soil
};
/// The ground within `view`.
/// @param bed    with its end walls, as ground_line() gives it
/// @param metre  px per metre
/// @param tag    ends the names of the datablocks, so that several panels can live in one script
/// @param width  of the line [px]
GroundElements ground_elements(Script& script, const Polyline& bed, const Box& view, double metre,
                               const std::string& tag, double width = 2.2);

/// The outlines of the structures of a model: its boundaries but the ground.
std::vector<Polyline> structures_of(const Model& model);
/// Plot elements of structures, to be plotted before the ground, which hides their foundations.
std::vector<std::string> structure_elements(Script& script, const std::vector<Polyline>& structures,
                                            const std::string& tag);

inline constexpr const char* slide_colour = "#C9B79C";
/// Plot element of one outline of the slide before failure, whose data get `name`.
std::string slide_element(Script& script, const std::string& name, const std::vector<Vec2>& outline,
                          const char* colour = slide_colour);

}  // namespace talus::figures

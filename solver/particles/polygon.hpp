#pragma once
// Polygons of Boost.Geometry whose points are Vec2. Slow to compile: for source files only.

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/register/point.hpp>
#include <span>

#include "math/vec2.hpp"

BOOST_GEOMETRY_REGISTER_POINT_2D(talus::Vec2, double, boost::geometry::cs::cartesian, x, y)

namespace talus {

/// Counter-clockwise, first vertex not repeated.
using Polygon = boost::geometry::model::polygon<Vec2, false, false>;
using Polygons = boost::geometry::model::multi_polygon<Polygon>;

/// The polygon of an outline of either orientation.
inline Polygon to_polygon(std::span<const Vec2> outline) {
  Polygon polygon;
  polygon.outer().assign(outline.begin(), outline.end());
  boost::geometry::correct(polygon);
  return polygon;
}

}  // namespace talus

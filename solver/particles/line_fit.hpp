#pragma once
// The ground as the particles can see it: lines without what is finer than the spacing.

#include "particles/geometry_input.hpp"

namespace talus {

/// A line as the particles can see it.
struct FittedLine {
  Polyline line;
  double noise = 0.0;      ///< standard deviation of the survey's noise across the line [m]; 0 where it cannot be told
  double tolerance = 0.0;  ///< vertices nearer than this to the line through others were taken out [m]
  double moved = 0.0;      ///< greatest distance of a given vertex from the line, notches that were filled apart [m]
  int notches = 0;         ///< filled
  double deepest_notch = 0.0;  ///< [m]
};

/// Takes out what is finer than the particles can see.
/// - Where segments are shorter than dx, vertices are taken out by the method of Douglas and Peucker 1973, with a
///   tolerance of 0.1 dx or four times the noise, at most dx. What is left moves across the line, at most by the
///   tolerance, to where the sum of the squared distances of all given vertices is least: a survey with noise then
///   gives the line without.
/// - A notch that a disc of diameter dx cannot enter is filled up to where it can.
/// A line without either stays as it is, vertex by vertex.
/// @param line  [m], at least 2 vertices, neighbours apart
/// @param dx    particle spacing [m], > 0
FittedLine fit_line(const Polyline& line, double dx);

}  // namespace talus

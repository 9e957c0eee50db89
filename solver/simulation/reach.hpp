#pragma once
// How far a slide can go at most, judged before the run from its outlines, its strength and the ground.

#include "simulation/model.hpp"

namespace talus {

/// The line that falls from the slide to either side with the slope of the smallest friction, that of the walls
/// included: a body that slides on friction ends where it meets the ground (Heim 1932).
struct EnergyLine {
  double slope;  ///< tangent of the smallest friction angle [-], >= 0
  double left;   ///< y at x = 0 of the branch that falls to the left [m]
  double right;  ///< y at x = 0 of the branch that falls to the right [m]

  /// y of the line at an x outside the slide [m]; within the slide no less than the slide.
  double height(double x) const;
};
/// From the points of the slide that are the highest seen along the line. Pure; thread-safe.
/// @param slope  tangent of the friction angle [-], >= 0
EnergyLine energy_line(const Model& model, double slope);
EnergyLine energy_line(const Model& model);

/// Tangent of the smallest friction angle of materials and walls, 0 with free slip [-].
double least_friction(const Model& model);

/// Whether every column of the slide carries its own weight on cohesion alone, so that nothing moves: its unconfined
/// compressive strength, 2 c cos(phi)/(1 - sin(phi)), exceeds the weight of the slide's full height (lower bound
/// theorem of plasticity). Only on no-slip walls, which have the strength of the soil, and not with the regularized
/// law, which creeps. Conservative: false does not mean that the slide moves.
bool stands_by_cohesion(const Model& model);

/// Fall height H [m]: highest point of the slide over the lowest point of the slide and of the bed within its reach;
/// sets the scale sqrt(2 g H) of speed. The reach goes to either side as far as the energy line first meets the bed. A
/// closed bed is within reach as a whole, and so is any bed where gravity is not vertical.
double fall_height(const Model& model);

}  // namespace talus

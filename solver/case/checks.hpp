#pragma once
// Checks across keys: whether slide, bed, walls and field fit one another.

#include <vector>

#include "case/case.hpp"
#include "case/vertices.hpp"
#include "support/faults.hpp"

namespace talus {

/// Where the vertices of bed and outlines are written.
struct SourceLocations {
  Vertices bed;
  std::vector<Vertices> outlines;  ///< of each slide part
};

/// Slide parts apart from one another, above the bed, between its ends; as many particles as allowed.
void check_geometry(const Model& model, const SourceLocations& origins, Faults& faults);
/// Enough wall layers, friction where a field needs it, given coefficients as many as the field takes.
void check_choices(const Case& c, Faults& faults);
/// Legal input that is often a mistake: an open end within reach, a wall lower than the slide, a coarse time step.
std::vector<Fault> find_warnings(const Case& c);

}  // namespace talus

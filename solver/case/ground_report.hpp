#pragma once
// What the program made of the ground and the slide of a case, before anything is run.

#include <string>

#include "case/load.hpp"
#include "particles/line_fit.hpp"

namespace talus {

/// The shape of a case as the particles will see it.
struct GroundReport {
  std::string source;      ///< where the bed was given, or that it was joined from surfaces
  std::size_t given = 0;   ///< vertices of the bed
  std::size_t kept = 0;    ///< vertices of the bed as fitted
  FittedLine fitted;       ///< the bed and its end walls, fitted to the spacing
  Box slide;               ///< box around the soil, in the case's coordinates [m]
  double thickness = 0.0;  ///< greatest vertical thickness of the slide [m]
};

/// @param loaded  checked
GroundReport report_ground(const LoadedCase& loaded);

}  // namespace talus

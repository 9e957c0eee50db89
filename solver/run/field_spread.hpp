#pragma once
// What the realizations of a random field have in common.

#include <vector>

namespace talus {

/// Of one property at points, given the data.
struct FieldSpread {
  std::vector<double> median;  ///< as in PropertyValues: tan(phi) [-], Pa, kg/m3, Pa s
  std::vector<double> stdev;   ///< in the same unit; of friction that of the angle [rad]
};

}  // namespace talus

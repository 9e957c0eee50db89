#pragma once
// One line of a study's books: what became of one realization.

#include <cstdint>
#include <string>

#include "support/measures.hpp"

namespace talus {

/// A finished or failed realization. Of a failed one only `index` and `reason` mean anything.
struct Record {
  std::int64_t index = 0;          ///< realization, or replicate of the noise floor
  bool done = false;               ///< false: failed
  Measures measures = {};          ///< [m]
  double mean_phi_deg = 0.0;       ///< mean friction angle over the soil particles [deg]
  double captured_variance = 0.0;  ///< [-]
  std::int64_t steps = 0;
  double wall_clock = 0.0;  ///< [s]
  std::string digest = {};  ///< of the final state
  std::string reason = {};  ///< why it failed, one line; empty if done
};

}  // namespace talus

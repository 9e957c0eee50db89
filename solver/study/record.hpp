#pragma once
// One line of a study's books: what became of one realization.

#include <array>
#include <cstdint>
#include <string>

#include "simulation/run_result.hpp"

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

/// The record of a run that came to its end.
Record done_record(std::int64_t index, const RunResult& result);

/// The measures by the name they have in every file.
struct MeasureColumn {
  const char* key;
  double Measures::*member;
};
inline constexpr std::array<MeasureColumn, 5> measure_columns{{{"influence_zone_m", &Measures::influence_zone},
                                                               {"front_connected_m", &Measures::front_connected},
                                                               {"front_mass_99_m", &Measures::front_mass_99},
                                                               {"front_mass_999_m", &Measures::front_mass_999},
                                                               {"centre_of_mass_x_m", &Measures::centre_of_mass_x}}};

}  // namespace talus

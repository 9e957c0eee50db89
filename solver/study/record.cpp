#include "study/record.hpp"

#include <cstdint>

#include "math/angle.hpp"

namespace talus {

Record done_record(std::int64_t index, const RunResult& result) {
  return {.index = index,
          .done = true,
          .measures = result.measures,
          .mean_phi_deg = degrees(result.field.mean_phi),
          .captured_variance = result.field.captured_variance,
          .steps = result.steps,
          .wall_clock = result.wall_clock,
          .digest = result.digest,
          .reason = {}};
}

}  // namespace talus

#pragma once
// What a Monte Carlo study asks for.

#include <cstdint>
#include <optional>
#include <vector>

namespace talus {

enum class Sampling { monte_carlo, latin_hypercube };

struct StudySpec {
  std::int64_t realizations = 100;    ///< planned, >= 1
  std::optional<std::uint64_t> seed;  ///< unset: random_seed(), recorded
  int noise_floor_replicates = 4;     ///< runs that differ by a relative 1e-6 of tan(phi) from realization 0; 0: none
  Sampling sampling = Sampling::monte_carlo;
  int stratified_modes = 5;               ///< leading modes that Latin hypercube sampling stratifies, >= 1
  std::optional<double> stop_half_width;  ///< stop once the 95 % interval of the mean influence zone is this narrow [m]
  double max_failed_share = 0.1;          ///< more failures than this end the study with exit code 7, in [0, 1]
  std::vector<double> histogram_edges;    ///< [m], increasing; empty: chosen from the data at round numbers
  bool operator==(const StudySpec&) const = default;
};

}  // namespace talus

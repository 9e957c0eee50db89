#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace talus {

/// Everything that a simulation needs to go on with the same bits: named arrays, opaque to those who store them.
struct CheckpointState {
  std::map<std::string, std::vector<double>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
  double wall_clock = 0.0;  ///< spent on the run so far [s]; kept for the caller, no part of the simulation
};

}  // namespace talus

#pragma once
// Where the time of a run goes.

#include <chrono>

namespace talus {

/// Wall clock spent in each stage of a run [s].
struct StageTimes {
  double sort = 0.0;      ///< sorting by cell
  double lists = 0.0;     ///< lists of neighbours
  double gradient = 0.0;  ///< first pass: velocity gradient, stress, walls near the soil
  double walls = 0.0;     ///< stress of the walls
  double momentum = 0.0;  ///< second pass: acceleration, walls near the soil
  double update = 0.0;    ///< packing, moving on, checking

  double total() const { return sort + lists + gradient + walls + momentum + update; }
};

/// Adds the time since the last lap to a stage.
class Stopwatch {
 public:
  void lap(double& stage) {
    const auto now = std::chrono::steady_clock::now();
    stage += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace talus

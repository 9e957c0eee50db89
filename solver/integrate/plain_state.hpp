#pragma once
// The plain back end of the integrators: the soil's own arrays, in double precision.

#include <functional>
#include <vector>

#include "integrate/schemes.hpp"
#include "particles/particles.hpp"

namespace talus {

/// Evaluates the rates of the soil at its present state: writes ax, ay, drho, dt**; may change t** (return to yield).
using Evaluate = std::function<void(Soil&)>;

/// The state at the start of a step, kept while the soil's arrays hold the middle. Its memory is reused.
struct StepStart {
  std::vector<double> x, y, vx, vy, rho, txx, tyy, txy;  ///< as in Soil
  void save(const Soil& soil);
};

/// Lets the schemes of integrate/schemes.hpp move `soil`. Refers to its arguments, which must live longer.
class PlainState {
 public:
  PlainState(Soil& soil, StepStart& start, const Evaluate& evaluate)
      : soil_(soil), start_(start), evaluate_(evaluate) {}

  void evaluate(double ahead, bool commit);
  void move(double dt, PositionVelocity velocity);

 private:
  void predict(double ahead);

  Soil& soil_;
  StepStart& start_;
  const Evaluate& evaluate_;
};

}  // namespace talus

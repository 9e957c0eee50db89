#pragma once
// What makes the result of a run doubtful or invalid.

#include <cstdint>
#include <optional>
#include <span>

#include "math/vec2.hpp"
#include "sph/numerics.hpp"
#include "support/quality.hpp"

namespace talus {

/// Largest Courant numbers at which an integrator is stable, measured (simulation/README.md): with the elastic law the
/// leapfrog lets the deposit shake from 0.55 on and the midpoint rule from 0.85 on, and a little beyond the front is
/// wrong by metres. [-]
constexpr double courant_limit(Integrator integrator) { return integrator == Integrator::leapfrog ? 0.4 : 0.8; }

/// What the checks look at. The defaults are those of a run without fault; what is unset is not checked.
struct RunFacts {
  double created_share = 0.0;            ///< energy that no term of the balance explains over the work of gravity [-]
  double mach = 0.0;                     ///< peak speed over the speed of sound [-]
  double density_rise = 0.0;             ///< largest rho/rho0 - 1 of any particle at any time [-]
  std::int64_t soil = 1;                 ///< particles
  std::int64_t penetrated = 0;           ///< of them, those that were ever lost in the ground
  std::int64_t left_domain = 0;          ///< of them, those that left through an open end
  std::int64_t at_open_end = 0;          ///< of them, those that came to within a spacing of an open end
  double dx = 1.0;                       ///< particle spacing [m]
  double time = 0.0;                     ///< reached [s]
  std::optional<double> rms_speed = {};  ///< at the end, over sqrt(|g| H) [-]; unset: the soil has no strength
  std::optional<double> run_on = {};     ///< by which the front may still advance [m]; unset as rms_speed
  std::optional<double> rows = {};       ///< particles across the slide at the start
  std::optional<double> correlation_length =
      {};                              ///< shortest, of a field that varies and is not averaged over cells [m]
  std::optional<double> courant = {};  ///< of a fixed time step [-]
  double courant_limit = 1.0;          ///< of the integrator [-]
};

/// Every check that objects, in the order of the table in checks.cpp. Pure; thread-safe.
Quality assess(const RunFacts& facts);

/// Particles across a slide at its thickest: the smaller of the largest numbers in a column and in a row of cells.
/// @param points  starting positions
/// @param dx      their spacing [m]
double rows_across(std::span<const Vec2> points, double dx);

}  // namespace talus

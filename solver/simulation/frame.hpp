#pragma once
// What a run shows of itself: frames for pictures, measures for statistics, a result for the record, a state for
// resuming.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "math/vec2.hpp"
#include "support/measures.hpp"

namespace talus {

/// All particles at one time, in order of id: soil 0..n_soil-1, then walls. Every array has the same length.
struct Frame {
  double time = 0.0;                          ///< [s]
  std::int64_t step = 0;                      ///< steps made
  std::size_t n_soil = 0;                     ///< how many of the particles are soil
  std::vector<Vec2> position;                 ///< [m]
  std::vector<Vec2> displacement;             ///< since the start [m]
  std::vector<Vec2> velocity;                 ///< [m/s]
  std::vector<double> density;                ///< [kg/m3]
  std::vector<double> pressure;               ///< [Pa], positive in compression
  std::vector<double> tan_phi;                ///< tangent of the friction angle [-]; 0 for walls
  std::vector<double> shear_rate;             ///< gamma_dot [1/s]
  std::vector<std::array<double, 4>> stress;  ///< sigma xx, yy, zz, xy [Pa], positive in tension
};

/// The random field of a run in three numbers.
struct FieldSummary {
  double captured_variance = 0.0;  ///< share of the variance that the truncated expansion carries [-]
  double mean_phi = 0.0;           ///< mean over the soil particles of the friction angle [rad]
  std::int64_t terms = 0;          ///< coefficients used
};

/// Why a run ended.
enum class Ending { end_time, at_rest, interrupted };

/// The outcome of a run.
struct RunResult {
  Measures measures;
  Ending ending = Ending::end_time;
  std::int64_t soil = 0;  ///< particles
  std::int64_t wall = 0;  ///< particles
  std::int64_t steps = 0;
  double time = 0.0;             ///< reached [s]
  std::int64_t evaluations = 0;  ///< right-hand sides evaluated (whole particle set each)
  double wall_clock = 0.0;       ///< [s]
  int threads = 1;
  double max_speed = 0.0;        ///< peak over the run [m/s]
  double final_max_speed = 0.0;  ///< [m/s]
  std::int64_t penetrated = 0;   ///< soil particles ever seen behind a wall; must be 0
  std::int64_t left_domain = 0;  ///< soil particles that left through an open end
  bool at_rest = false;          ///< final_max_speed below 1 % of sqrt(|g| H)
  std::string digest;            ///< 16 hex digits over the final state in order of id
  FieldSummary field;
};

/// A line of the run's history.
struct HistoryRow {
  double time = 0.0;  ///< [s]
  std::int64_t step = 0;
  double front = 0.0;             ///< farthest soil particle from the left boundary [m]
  double centre_of_mass_x = 0.0;  ///< [m]
  double kinetic_energy = 0.0;    ///< [J/m]
  double max_speed = 0.0;         ///< [m/s]
};

/// Everything needed to go on exactly where a run stopped: named arrays, opaque to those who store them.
struct State {
  std::map<std::string, std::vector<double>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
};

}  // namespace talus

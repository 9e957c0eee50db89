#pragma once
// The outcome of a run, and the rows of its history.

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/energy_budget.hpp"
#include "support/error.hpp"
#include "support/measures.hpp"
#include "support/quality.hpp"
#include "support/targets.hpp"

namespace talus {

/// What came out for one random property, in the unit of property_names.
struct PropertySummary {
  std::string name;       ///< "cohesion"
  double mean = 0.0;      ///< of the distribution that is drawn from, over the particles that it applies to
  double cov = 0.0;       ///< coefficient of variation of the same: averaging over cells included [-]
  double run_mean = 0.0;  ///< mean over these particles in this run
  double run_cov = 0.0;   ///< coefficient of variation over these particles in this run [-]
};

/// The random field of a run in a few numbers.
struct FieldSummary {
  double captured_variance = 0.0;  ///< share of the variance that the truncated expansion carries [-]
  double cov = 0.0;                ///< coefficient of variation of tan(phi) that is drawn, from the mean variance [-]
  double mean_phi = 0.0;           ///< mean over the soil particles of the friction angle [rad]
  std::int64_t terms = 0;          ///< coefficients used
  double embedding_error = 0.0;    ///< bound of the error of any covariance that circulant embedding makes [-]
  std::vector<PropertySummary> properties = {};  ///< empty in the short form of the field, and without one
};

/// What the particles carry of the soil of a case, per metre of width.
struct SlideMass {
  double filled = 0.0;   ///< sum over the particles [kg/m]; 0: not recorded
  double outline = 0.0;  ///< sum of density x area of the outlines above the ground [kg/m]; 0: not recorded
};

/// Why a run ended.
enum class Ending { end_time, at_rest, interrupted };

/// The outcome of a run.
struct RunResult {
  Measures measures;
  double front_thickness = 0.0;                ///< of the soil at measures.front_at_thickness [m]; 0: not recorded
  std::vector<std::string> notes = {};         ///< notes_on() the measures
  std::vector<std::string> lower_bounds = {};  ///< keys of the measures of which soil that left makes lower bounds
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
  std::int64_t penetrated = 0;   ///< soil particles that were ever deep in the ground; must be 0
  std::int64_t left_domain = 0;  ///< soil particles that left through an open end
  bool at_rest = false;          ///< by the rule of the case (then `ending` says so), or by that of the verdict
  SlideMass mass;
  std::string digest;             ///< 16 hex digits over the final state in order of id
  std::string backend = "plain";  ///< the loops that ran: "vectorised" or "plain"; empty: not recorded
  std::string simd = "none";      ///< instruction set of the vectorised loops, otherwise "none"; empty: not recorded
  FieldSummary field;
  EnergyBudget energy = {};  ///< at the end
  Quality quality = {};
  std::vector<TargetOutcome> targets = {};  ///< in the order of the case
  std::vector<Fault> warnings = {};         ///< of the case: what can be run but may not be meant
};

/// A line of the run's history.
struct HistoryRow {
  double time = 0.0;  ///< [s]
  std::int64_t step = 0;
  double front = 0.0;             ///< run-out of the farthest soil particle [m]
  double centre_of_mass_x = 0.0;  ///< [m]
  double kinetic_energy = 0.0;    ///< of all soil, also that which has left [J/m]
  double max_speed = 0.0;         ///< [m/s]
  EnergyBudget energy;
};

}  // namespace talus

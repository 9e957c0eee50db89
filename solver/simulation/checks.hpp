#pragma once
// What makes the result of a run doubtful or invalid.

#include <cstdint>
#include <optional>
#include <span>

#include "math/vec2.hpp"
#include "simulation/energy_budget.hpp"
#include "simulation/model.hpp"
#include "support/quality.hpp"

namespace talus {

/// The largest Courant number c dt/h, and the largest diffusion number nu dt/h^2, at which an integrator is stable [-];
/// measured, see README.md.
constexpr double stable_cfl(Integrator integrator) { return integrator == Integrator::leapfrog ? 0.4 : 0.8; }

/// Root-mean-square speed of a slide at rest over sqrt(|g| H), at most [-].
inline constexpr double rest_speed = 0.01;
/// By how many spacings the front of a slide at rest may still advance [-].
inline constexpr double rest_advance = 1.0;
/// By how many spacings a front may lie ahead of another before its soil counts as thrown or separate [-].
inline constexpr double thrown_ahead = 5.0;

/// What the checks look at. The defaults are those of a run without fault; what is unset is not checked.
struct RunFacts {
  EnergyBudget energy = {};              ///< at the end
  bool steady_contact = true;            ///< the walls act at all times, not only on soil that approaches them
  double weight = 1.0;                   ///< of all soil [N/m]
  double mach = 0.0;                     ///< peak speed over the speed of sound [-]
  double density_rise = 0.0;             ///< largest rho/rho0 - 1 of any particle at any time [-]
  std::int64_t soil = 1;                 ///< particles
  std::int64_t penetrated = 0;           ///< of them, those that were ever lost in the ground
  std::int64_t left_domain = 0;          ///< of them, those that left through an open end
  std::int64_t at_open_end = 0;          ///< of them, those that lie within 2h of an open end
  double dx = 1.0;                       ///< particle spacing [m]
  double time = 0.0;                     ///< reached [s]
  std::optional<double> rms_speed = {};  ///< at the end, over sqrt(|g| H) [-]
  std::optional<double> run_on = {};     ///< by which the front may still advance on friction [m]
  std::optional<double> creep = {};  ///< of the front in as long again [m]; unset where rms_speed is above rest_speed
  std::optional<double> rows = {};   ///< particles across the slide at the start
  /// By how much the front of 99 % of the mass lies ahead of the connected body, of soil without a rate-dependent
  /// dissipation [m].
  std::optional<double> separate_front = {};
  std::optional<double> flow_rows = {};  ///< particles across the slide on its way, on average
  double mass_change = 0.0;              ///< mass of the particles over density x area of the outlines, less 1 [-]
  /// Smallest friction of any soil particle or wall [-]; unset: none, or gravity is not vertical.
  std::optional<double> least_friction = {};
  double beyond_energy_line = 0.0;  ///< share of the mass more than dx above the energy line of that friction [-]
  double travel = 0.0;              ///< mean distance along x between the start of a particle and its end [m]
  std::optional<double> correlation_length = {};  ///< shortest, of a field that is not averaged over cells [m]
  std::optional<double> courant = {};             ///< of a fixed time step [-]
  std::optional<double> diffusion_number = {};    ///< of a fixed time step, nu dt/h^2; unset without a viscosity [-]
  double courant_limit = 1.0;                     ///< of the integrator, for both [-]
};

/// Every check that objects, in the order of the table in checks.cpp. Pure; thread-safe.
Quality assess(const RunFacts& facts);

/// The facts that are known before the run, but for the random field.
/// @param starts  starting positions of the soil particles
RunFacts facts_before_run(const Model& model, std::span<const Vec2> starts);

/// Particles across a slide at its thickest: the smaller of the largest numbers in a column and in a row of cells.
/// @param points  starting positions
/// @param dx      their spacing [m]
double rows_across(std::span<const Vec2> points, double dx);

}  // namespace talus

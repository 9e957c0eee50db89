#include "simulation/checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "simulation/particle_setup.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// A check objects where its value is beyond a limit.
struct Check {
  const char* key;
  std::optional<double> (*value)(const RunFacts&);  ///< unset: nothing to check
  double doubtful;                                  ///< the last value that is allowed
  std::optional<double> invalid;                    ///< a further limit; unset: the check makes no run invalid
  std::string (*message)(const RunFacts&, double value);
  bool below = false;  ///< it objects to values below the limit
};

using Value = std::optional<double>;

std::string percent(double share) { return rounded(100.0 * share) + " %"; }
double share(std::int64_t n, const RunFacts& f) { return static_cast<double>(n) / static_cast<double>(f.soil); }
std::string particles(std::int64_t n, const RunFacts& f) {
  return std::to_string(n) + " of " + std::to_string(f.soil) + " particles";
}

/// What gravity gave [J/m]. A slide that hardly moves is compared with a fall by one spacing, below which the method
/// resolves nothing.
double gravity_work(const RunFacts& f) { return std::max(f.energy.gravity_work(), f.weight * f.dx); }

double created_share(const RunFacts& f) { return f.energy.created() / gravity_work(f); }

/// What the method itself takes, over gravity's work.
double numerical_share(const RunFacts& f) {
  return (f.energy.artificial_viscosity + f.energy.density_diffusion) / gravity_work(f);
}

constexpr Check checks[] = {
    // Stable runs of all trials create less than 0.9 % of gravity's work; unstable ones, whose fronts are wrong by
    // metres, 16 % and more.
    {"energy_created", [](const RunFacts& f) { return f.steady_contact ? Value(created_share(f)) : Value(); }, 0.01,
     0.1,
     [](const RunFacts&, double x) {
       return "the numerical method created energy equal to " + percent(x) + " of gravity's work";
     }},
    // What the soil's strength and viscosity do not take decides the run-out in their place, and falls with the
    // spacing. A share of a tenth is about a tenth of the run-out.
    {"numerical_dissipation",
     [](const RunFacts& f) { return Value(numerical_share(f)); },
     0.1,
     {},
     [](const RunFacts&, double x) {
       return percent(x) +
              " of the energy went into artificial viscosity and density diffusion, which fall with the spacing, "
              "so that they decide the run-out: state a viscosity or mu_i, or refine";
     }},
    // Walls that act on approaching particles only ([Z20]) create energy whenever they switch on and off. A case must
    // ask for that method, and its run is never more than doubtful for it.
    {"energy_created",
     [](const RunFacts& f) { return f.steady_contact ? Value() : Value(created_share(f)); },
     0.01,
     {},
     [](const RunFacts&, double x) {
       return "walls that act on approaching particles only (walls.contact) created energy equal to " + percent(x) +
              " of gravity's work";
     }},
    // Density varies as the square of the Mach number: at 0.2 by 4 %, four times as much as with a speed of sound of
    // ten times the fastest fall (Monaghan 1994). A run at 0.7 went twice as far.
    {"mach_number", [](const RunFacts& f) { return Value(f.mach); }, 0.2, 0.5,
     [](const RunFacts&, double x) {
       return "the fastest particle reached " + rounded(x) + " times the speed of sound (numerics.sound_speed_m_s)";
     }},
    // Sound runs stay below 4.2 %, impacts below a cliff included. A run at 9 % went 12 % too far, one at 30 % twice as
    // far.
    {"compression", [](const RunFacts& f) { return Value(f.density_rise); }, 0.05, 0.2,
     [](const RunFacts&, double x) { return "soil was compressed to " + percent(x) + " above its density"; }},
    // One particle says that the ground leaks, but moves no front; more than 1 % is mass that is missing.
    {"particles_in_ground", [](const RunFacts& f) { return Value(share(f.penetrated, f)); }, 0.0, 0.01,
     [](const RunFacts& f, double) {
       return particles(f.penetrated, f) + " were deeper than half a spacing in the ground";
     }},
    {"left_terrain",
     [](const RunFacts& f) { return Value(share(f.left_domain, f)); },
     0.0,
     {},
     [](const RunFacts& f, double) {
       return particles(f.left_domain, f) + " left over an end of the bed, so the run-out ends where the bed ends";
     }},
    {"front_at_open_end",
     [](const RunFacts& f) { return Value(share(f.at_open_end, f)); },
     0.0,
     {},
     [](const RunFacts& f, double) {
       return particles(f.at_open_end, f) + " lie within a spacing of an open end of the bed";
     }},
    // A hundredth of the speed scale of the fall: the front of a trial that ended at 3 % was 0.2 % short.
    {"still_moving",
     [](const RunFacts& f) { return f.rms_speed; },
     rest_speed,
     {},
     [](const RunFacts& f, double x) {
       return "the slide moved at " + percent(x) + " of sqrt(g H) when the run ended at t = " + to_text(f.time) +
              " s, so its run-out is not final";
     }},
    // As far as the fastest soil near the front slides on friction, in spacings.
    {"front_still_moving",
     [](const RunFacts& f) { return f.run_on ? Value(*f.run_on / f.dx) : Value(); },
     rest_advance,
     {},
     [](const RunFacts& f, double) {
       return "when the run ended at t = " + to_text(f.time) + " s single particles could slide " + rounded(*f.run_on) +
              " m beyond the front";
     }},
    // Viscous soil may move at a hundredth of the speed of its fall and still go on for as long as one waits.
    {"creeping",
     [](const RunFacts& f) { return f.creep ? Value(*f.creep / f.dx) : Value(); },
     rest_advance,
     {},
     [](const RunFacts& f, double) {
       return "the front still moved when the run ended at t = " + to_text(f.time) +
              " s: at its speed it would advance " + rounded(*f.creep) + " m in as long again";
     }},
    // A slide of 4 rows went a quarter of its way, one of 5 as far as one of 10, to 1 %. The limit keeps off slides
    // that
    // do not flow; it does not say that the front has converged.
    {"few_particles_across",
     [](const RunFacts& f) { return f.rows; },
     5.0,
     {},
     [](const RunFacts&, double x) {
       return "the slide is " + rounded(x) + " particles thick at most, where 5 are needed";
     },
     true},
    // A value at the centre of a particle does not stand for its cell, across which the field decorrelates.
    {"short_correlation_length",
     [](const RunFacts& f) { return f.correlation_length ? Value(*f.correlation_length / f.dx) : Value(); },
     1.0,
     {},
     [](const RunFacts& f, double) {
       return "the correlation length of " + rounded(*f.correlation_length) + " m is below the particle spacing of " +
              rounded(f.dx) + " m";
     },
     true},
    {"unstable_time_step",
     [](const RunFacts& f) { return f.courant ? Value(*f.courant / f.courant_limit) : Value(); },
     1.0,
     {},
     [](const RunFacts& f, double) {
       return "the fixed time step has the Courant number " + rounded(*f.courant) +
              ", where the integrator is stable up to " + rounded(f.courant_limit);
     }},
    // The viscous part of the same limit (Morris, Fox & Zhu 1997, J. Comput. Phys. 136, whose 0.125 bounds the Courant
    // step).
    {"unstable_time_step",
     [](const RunFacts& f) { return f.diffusion_number ? Value(*f.diffusion_number / f.courant_limit) : Value(); },
     1.0,
     {},
     [](const RunFacts& f, double) {
       return "the fixed time step has the diffusion number nu dt/h^2 = " + rounded(*f.diffusion_number) +
              " with the largest viscosity, where the integrator is stable up to " + rounded(f.courant_limit);
     }},
};

/// Not a number is beyond every limit.
bool beyond(const Check& check, double value, double limit) {
  return check.below ? !(value >= limit) : !(value <= limit);
}

}  // namespace

Quality assess(const RunFacts& facts) {
  Quality quality{.verdict = Verdict::sound};
  for (const Check& check : checks) {
    const Value value = check.value(facts);
    if (!value || !beyond(check, *value, check.doubtful)) continue;
    const bool invalid = check.invalid && beyond(check, *value, *check.invalid);
    const Verdict verdict = invalid ? Verdict::invalid : Verdict::doubtful;
    quality.reasons.push_back({.check = check.key,
                               .verdict = verdict,
                               .value = *value,
                               .limit = invalid ? *check.invalid : check.doubtful,
                               .message = check.message(facts, *value)});
    quality.verdict = std::max(quality.verdict, verdict);
  }
  return quality;
}

RunFacts facts_before_run(const Model& model, std::span<const Vec2> starts) {
  RunFacts facts;
  facts.soil = static_cast<std::int64_t>(starts.size());
  facts.dx = model.dx;
  facts.steady_contact = model.walls.contact == WallContact::always;
  facts.rows = rows_across(starts, model.dx);
  const StepBounds bounds = step_bounds(model, flow_constants(model));
  if (model.time.fixed_step) {
    facts.courant = *model.time.fixed_step * bounds.c / bounds.h;
    if (bounds.nu > 0.0) facts.diffusion_number = *model.time.fixed_step * bounds.nu / (bounds.h * bounds.h);
  }
  facts.courant_limit = stable_cfl(model.numerics.integrator);
  return facts;
}

double rows_across(std::span<const Vec2> points, double dx) {
  std::map<std::int64_t, std::int64_t> columns, rows;
  std::int64_t column = 0, row = 0;
  for (const Vec2& point : points) {
    column = std::max(column, ++columns[static_cast<std::int64_t>(std::floor(point.x / dx))]);
    row = std::max(row, ++rows[static_cast<std::int64_t>(std::floor(point.y / dx))]);
  }
  return static_cast<double>(std::min(column, row));
}

}  // namespace talus

#include "simulation/checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "math/angle.hpp"
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

/// Potential energy that was lost, over the work of the least friction on the way along x; unset where the slide has
/// moved by less than a spacing. Simple shear under its own weight takes |g| tan(phi) integral of m |v_x| dt whatever
/// the profile of the velocity is, and so does a body that falls and lands without a bounce.
std::optional<double> friction_ratio(const RunFacts& f) {
  if (!f.least_friction || !(f.travel > f.dx)) return {};
  return (f.energy.gravity_work() - f.energy.kinetic - f.energy.departed) / (*f.least_friction * f.weight * f.travel);
}

std::string least_angle(const RunFacts& f) { return rounded(degrees(std::atan(*f.least_friction))) + " degrees"; }

double created_share(const RunFacts& f) { return f.energy.created() / gravity_work(f); }

double numerical_share(const RunFacts& f) { return f.energy.numerical() / gravity_work(f); }

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
              " of the energy went into artificial viscosity and density diffusion instead of the soil's friction and "
              "viscosity, so that they decide the run-out: refine, and state a viscosity or mu_i where the soil has "
              "none (soil that falls onto the ground loses its energy this way at any spacing)";
     }},
    // What slides on friction comes to rest below the energy line (Heim 1932). The tip of a slide may pass it, pushed
    // from behind, the tip of a dam break by its way to the line once more (Savage & Hutter 1989); with 1 % of the mass
    // it is the front of the run, and single rows of particles make it.
    {"beyond_energy_line",
     [](const RunFacts& f) { return f.least_friction ? Value(f.beyond_energy_line) : Value(); },
     0.01,
     {},
     [](const RunFacts& f, double x) {
       return percent(x) + " of the soil ended more than a spacing above the energy line at " + least_angle(f) +
              ", the least friction angle, so the front is farther than friction lets a body slide";
     }},
    // All trials lie at 1 and above, but those that friction does not hold.
    {"too_little_friction",
     friction_ratio,
     0.95,
     {},
     [](const RunFacts& f, double x) {
       return "the soil lost " + percent(x) + " of the energy that friction at " + least_angle(f) +
              ", the least friction angle, takes on its way";
     },
     true},
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
       return particles(f.at_open_end, f) + " lie within the kernel's reach, 2h, of an open end of the bed";
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
    // The support of the default kernel reaches three spacings to each side: in a thinner flow every particle feels bed
    // and surface at once. With fewer on average the front moved by 2 to 3.4 spacings when the spacing was halved.
    {"thin_flow",
     [](const RunFacts& f) { return f.flow_rows; },
     3.0,
     {},
     [](const RunFacts&, double x) {
       return "on its way the slide is " + rounded(x) +
              " particles thick on average, where 3 are needed (particle_spacing_m)";
     },
     true},
    // Single particles lie where their friction has stopped them, with less of it than a row of them. Of soil that
    // states a viscosity such a front agreed within 2 % at two spacings, of soil that states none it moved by 7 to 14
    // %.
    {"separate_front",
     [](const RunFacts& f) { return f.separate_front ? Value(*f.separate_front / f.dx) : Value(); },
     thrown_ahead,
     {},
     [](const RunFacts& f, double) {
       return "the front of 99 % of the mass lies " + rounded(*f.separate_front) +
              " m ahead of the connected body, and the soil states neither a viscosity nor mu_i that would slow single "
              "particles";
     }},
    // The run-out follows the mass: a column whose particles carry 8 % more went 10 % farther.
    {"mass_changed",
     [](const RunFacts& f) { return Value(std::abs(f.mass_change)); },
     0.05,
     {},
     [](const RunFacts& f, double x) {
       return "the particles carry " + percent(x) + (f.mass_change > 0.0 ? " more" : " less") +
              " mass than density x area of the outlines (particle_placement cells carries that of the outlines)";
     }},
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

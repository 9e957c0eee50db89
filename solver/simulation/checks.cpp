#include "simulation/checks.hpp"

#include <cmath>
#include <cstdio>
#include <map>

#include "support/text.hpp"

namespace talus {
namespace {

/// A check objects where its value is beyond a limit.
struct Check {
  const char* key;
  std::optional<double> (*value)(const RunFacts&);
  double doubtful;                ///< limit, itself allowed
  std::optional<double> invalid;  ///< a further limit; unset: the check never makes a run invalid
  std::string (*message)(const RunFacts&, double value);
  bool below = false;  ///< it objects to values below the limit
};

std::string percent(double share) { return rounded(100.0 * share) + " %"; }
std::string of_particles(std::int64_t n, const RunFacts& f) {
  return std::to_string(n) + " of " + std::to_string(f.soil) + " particles";
}
double share(std::int64_t n, const RunFacts& f) { return static_cast<double>(n) / static_cast<double>(f.soil); }

constexpr Check checks[] = {
    // A stable run explains what gravity gave to well below 1 %; of runs that created more than 10 % the fronts are
    // wrong by metres.
    {"energy_created", [](const RunFacts& f) { return std::optional(f.created_share); }, 0.01, 0.10,
     [](const RunFacts&, double x) {
       return "energy equal to " + percent(x) + " of gravity's work was created by the numerical method";
     }},
    // Density varies as Mach^2: 0.2 is 4 %, four times what a speed of sound of ten times the fastest fall gives
    // (Monaghan 1994). At 1 pressure waves are slower than the soil.
    {"mach_number", [](const RunFacts& f) { return std::optional(f.mach); }, 0.2, 1.0,
     [](const RunFacts&, double x) {
       return "the fastest particle had " + rounded(x) +
              " times the speed of sound of the model (numerics.sound_speed_m_s)";
     }},
    {"compression",
     [](const RunFacts& f) { return std::optional(f.density_rise); },
     0.05,
     {},
     [](const RunFacts&, double x) {
       return "soil was compressed to " + percent(x) + " above its density, which soil is not";
     }},
    // One particle is enough to doubt the ground, but does not move a front; beyond 1 % mass is missing.
    {"particles_in_ground", [](const RunFacts& f) { return std::optional(share(f.penetrated, f)); }, 0.0, 0.01,
     [](const RunFacts& f, double) {
       return of_particles(f.penetrated, f) + " were deeper than half a spacing in the ground";
     }},
    {"left_terrain",
     [](const RunFacts& f) { return std::optional(share(f.left_domain, f)); },
     0.0,
     {},
     [](const RunFacts& f, double) {
       return of_particles(f.left_domain, f) + " left through an open end of the bed, so fronts end where the bed ends";
     }},
    {"front_at_open_end",
     [](const RunFacts& f) { return std::optional(share(f.at_open_end, f)); },
     0.0,
     {},
     [](const RunFacts& f, double) {
       return of_particles(f.at_open_end, f) + " came to within a spacing of an open end of the bed";
     }},
    // The bulk: a hundredth of the speed scale of the fall. The front: as far as its fastest soil slides on friction.
    {"still_moving",
     [](const RunFacts& f) { return f.rms_speed; },
     0.01,
     {},
     [](const RunFacts& f, double x) {
       return "the slide moved at " + percent(x) +
              " of the speed scale sqrt(g H) when the run ended at t = " + to_text(f.time) +
              " s, so its run-out is not final";
     }},
    {"front_still_moving",
     [](const RunFacts& f) { return f.run_on ? std::optional(*f.run_on / f.dx) : std::nullopt; },
     1.0,
     {},
     [](const RunFacts& f, double) {
       return "at the speed it had when the run ended at t = " + to_text(f.time) + " s the front advances by another " +
              rounded(*f.run_on) + " m";
     }},
    {"few_particles_across",
     [](const RunFacts& f) { return f.rows; },
     5.0,
     {},
     [](const RunFacts&, double x) { return "the slide is " + rounded(x) + " particles thick, at least 5 are needed"; },
     true},
    // The value at the centre of a cell does not stand for a cell across which the field decorrelates.
    {"short_correlation_length",
     [](const RunFacts& f) {
       return f.correlation_length ? std::optional(*f.correlation_length / f.dx) : std::nullopt;
     },
     1.0,
     {},
     [](const RunFacts& f, double) {
       return "the correlation length of " + rounded(*f.correlation_length) + " m is below the particle spacing of " +
              rounded(f.dx) + " m (random_field.cell_average)";
     },
     true},
    {"time_step",
     [](const RunFacts& f) { return f.courant ? std::optional(*f.courant / f.courant_limit) : std::nullopt; },
     1.0,
     {},
     [](const RunFacts& f, double) {
       return "time.fixed_step_s has the Courant number " + rounded(*f.courant) + ", the integrator is stable up to " +
              rounded(f.courant_limit);
     }},
};

bool beyond(const Check& check, double value, double limit) { return check.below ? value < limit : !(value <= limit); }

}  // namespace

Quality assess(const RunFacts& facts) {
  Quality quality{.verdict = Verdict::sound};
  for (const Check& check : checks) {
    const std::optional<double> value = check.value(facts);
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

// Every check on both sides of its limits.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "models.hpp"
#include "simulation/checks.hpp"
#include "simulation/particle_setup.hpp"

namespace talus {
namespace {

using namespace testing_support;

struct Row {
  const char* check;
  double limit;
  Verdict beyond;
  std::function<void(RunFacts&, double)> set;  ///< makes the value of the check
  const char* message;                         ///< part of it just beyond the limit
  bool below = false;
};

/// Gravity has done 1000 J/m of work.
RunFacts facts() {
  RunFacts f;
  f.energy.potential = -1000.0;
  f.energy.kinetic = 1000.0;
  f.soil = 1000;
  f.dx = 0.5;
  f.time = 9.0;
  return f;
}

const std::vector<Row> rows{
    {"energy_created", 0.01, Verdict::doubtful, [](RunFacts& f, double x) { f.energy.kinetic += 1000.0 * x; },
     "created energy equal to 1.01 % of gravity's work"},
    {"energy_created", 0.1, Verdict::invalid, [](RunFacts& f, double x) { f.energy.friction = 1000.0 * x; }, "10.1 %"},
    {"numerical_dissipation", 0.1, Verdict::doubtful,
     [](RunFacts& f, double x) {
       f.energy.artificial_viscosity = 900.0 * x;
       f.energy.density_diffusion = 100.0 * x;
       f.energy.kinetic -= 1000.0 * x;
     },
     "10.1 % of the energy went into artificial viscosity and density diffusion"},
    {"beyond_energy_line", 0.01, Verdict::doubtful,
     [](RunFacts& f, double x) {
       f.least_friction = 0.5;
       f.beyond_energy_line = x;
     },
     "1.01 % of the soil ended more than a spacing above the energy line at 26.6 degrees"},
    {"too_little_friction", 0.95, Verdict::doubtful,
     [](RunFacts& f, double x) {
       f.least_friction = 0.5;
       f.travel = 2.0;
       f.weight = 800.0;  // friction takes 0.5 * 800 * 2 J/m
       f.energy.friction = 800.0 * x;
       f.energy.kinetic = 1000.0 - f.energy.friction;
     },
     "94 % of the energy that friction at 26.6 degrees", true},
    {"mach_number", 0.2, Verdict::doubtful, [](RunFacts& f, double x) { f.mach = x; },
     "0.202 times the speed of sound"},
    {"mach_number", 0.5, Verdict::invalid, [](RunFacts& f, double x) { f.mach = x; }, "0.505 times"},
    {"compression", 0.05, Verdict::doubtful, [](RunFacts& f, double x) { f.density_rise = x; }, "compressed to 5.05 %"},
    {"compression", 0.2, Verdict::invalid, [](RunFacts& f, double x) { f.density_rise = x; }, "20.2 %"},
    {"still_moving", 0.01, Verdict::doubtful, [](RunFacts& f, double x) { f.rms_speed = x; },
     "at 1.01 % of sqrt(g H) when the run ended at t = 9 s"},
    {"front_still_moving", 1.0, Verdict::doubtful, [](RunFacts& f, double x) { f.run_on = 0.5 * x; },
     "0.505 m beyond the front"},
    {"creeping", 1.0, Verdict::doubtful, [](RunFacts& f, double x) { f.creep = 0.5 * x; },
     "at t = 9 s: at its speed it would advance 0.505 m in as long again"},
    {"few_particles_across", 5.0, Verdict::doubtful, [](RunFacts& f, double x) { f.rows = x; }, "4.95 particles thick",
     true},
    {"thin_flow", 3.0, Verdict::doubtful, [](RunFacts& f, double x) { f.flow_rows = x; },
     "2.97 particles thick on average", true},
    {"separate_front", 5.0, Verdict::doubtful, [](RunFacts& f, double x) { f.separate_front = 0.5 * x; },
     "2.52 m ahead of the connected body"},
    {"mass_changed", 0.05, Verdict::doubtful, [](RunFacts& f, double x) { f.mass_change = x; },
     "carry 5.05 % more mass"},
    {"mass_changed", 0.05, Verdict::doubtful, [](RunFacts& f, double x) { f.mass_change = -x; },
     "carry 5.05 % less mass"},
    {"short_correlation_length", 1.0, Verdict::doubtful, [](RunFacts& f, double x) { f.correlation_length = 0.5 * x; },
     "0.495 m is below the particle spacing of 0.5 m", true},
    {"unstable_time_step", 1.0, Verdict::doubtful,
     [](RunFacts& f, double x) {
       f.courant = 0.4 * x;
       f.courant_limit = 0.4;
     },
     "Courant number 0.404, where the integrator is stable up to 0.4"},
    {"unstable_time_step", 1.0, Verdict::doubtful,
     [](RunFacts& f, double x) {
       f.diffusion_number = 0.4 * x;
       f.courant_limit = 0.4;
     },
     "nu dt/h^2 = 0.404 with the largest viscosity, where the integrator is stable up to 0.4"}};

/// What `row.check` says of the value; nothing where it does not object.
const QualityReason* objection(const Quality& quality, const Row& row) {
  const auto at = std::ranges::find(quality.reasons, row.check, &QualityReason::check);
  return at == quality.reasons.end() ? nullptr : &*at;
}

TEST(Checks, AreSilentOnARunWithoutFault) {
  const Quality quality = assess(facts());
  EXPECT_EQ(quality.verdict, Verdict::sound);
  EXPECT_TRUE(quality.reasons.empty());
  EXPECT_EQ(assess(RunFacts{}).verdict, Verdict::sound);
}

TEST(Checks, ObjectBeyondTheirLimitsOnly) {
  for (const Row& row : rows) {
    const auto at = [&](double factor) {
      RunFacts f = facts();
      row.set(f, row.limit * factor);
      return assess(f);
    };
    const Quality inside = at(row.below ? 1.01 : 0.99), outside = at(row.below ? 0.99 : 1.01);
    const QualityReason* within = objection(inside, row);
    EXPECT_TRUE(within == nullptr || within->verdict < row.beyond) << row.check;
    EXPECT_LT(inside.verdict, row.beyond) << row.check;
    const QualityReason* reason = objection(outside, row);
    ASSERT_NE(reason, nullptr) << row.check;
    EXPECT_EQ(outside.reasons.size(), 1u) << row.check;
    EXPECT_EQ(outside.verdict, row.beyond) << row.check;
    EXPECT_EQ(reason->verdict, row.beyond) << row.check;
    EXPECT_DOUBLE_EQ(reason->limit, row.limit) << row.check;
    EXPECT_NE(reason->message.find(row.message), std::string::npos) << reason->message;
    EXPECT_EQ(reason->message.find(';'), std::string::npos) << "semicolons separate reasons in tables";
  }
}

TEST(Checks, ParticlesAreCounted) {
  const auto checks = [](auto set) {
    RunFacts f = facts();
    set(f);
    return assess(f);
  };
  const Quality one = checks([](RunFacts& f) { f.penetrated = 1; });
  ASSERT_EQ(one.reasons.size(), 1u);
  EXPECT_EQ(one.reasons[0].check, "particles_in_ground");
  EXPECT_EQ(one.reasons[0].message, "1 of 1000 particles were deeper than half a spacing in the ground");
  EXPECT_EQ(one.verdict, Verdict::doubtful);
  EXPECT_EQ(checks([](RunFacts& f) { f.penetrated = 10; }).verdict, Verdict::doubtful);
  EXPECT_EQ(checks([](RunFacts& f) { f.penetrated = 11; }).verdict, Verdict::invalid);
  const Quality gone = checks([](RunFacts& f) { f.left_domain = 1000; });
  ASSERT_EQ(gone.reasons.size(), 1u);
  EXPECT_EQ(gone.reasons[0].check, "left_terrain");
  EXPECT_EQ(gone.verdict, Verdict::doubtful);
  const Quality close = checks([](RunFacts& f) { f.at_open_end = 3; });
  ASSERT_EQ(close.reasons.size(), 1u);
  EXPECT_EQ(close.reasons[0].check, "front_at_open_end");
  EXPECT_EQ(close.reasons[0].message,
            "3 of 1000 particles lie within the kernel's reach, 2h, of an open end of the bed");
}

TEST(Checks, TheWorstReasonDecides) {
  RunFacts f = facts();
  f.penetrated = 1;
  f.mach = 0.6;
  f.rms_speed = 0.5;
  const Quality quality = assess(f);
  EXPECT_EQ(quality.verdict, Verdict::invalid);
  EXPECT_EQ(quality.reasons.size(), 3u);
  EXPECT_EQ(objections_in(objections_text(quality)).size(), 3u);
}

TEST(Checks, WallsThatSwitchOnAndOffMakeARunDoubtfulAtMost) {
  RunFacts f = facts();
  f.energy.kinetic *= 1.5;
  EXPECT_EQ(assess(f).verdict, Verdict::invalid);
  f.steady_contact = false;
  EXPECT_EQ(assess(f).verdict, Verdict::doubtful);
  EXPECT_NE(assess(f).reasons.at(0).message.find("walls.contact"), std::string::npos);
  Model m = collapse(0.05);
  const std::vector<Vec2> one{{0.1, 0.1}};
  EXPECT_TRUE(facts_before_run(m, one).steady_contact);
  m.walls.contact = WallContact::approaching;
  EXPECT_FALSE(facts_before_run(m, one).steady_contact);
}

TEST(Checks, NotANumberIsBeyondEveryLimit) {
  RunFacts f = facts();
  f.density_rise = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(assess(f).verdict, Verdict::invalid);
}

TEST(Checks, ASlideAtRestIsMeasuredByAFallOfOneSpacing) {
  RunFacts f;
  f.weight = 1e4;
  f.dx = 0.5;
  f.energy.kinetic = 0.009 * 5e3;
  EXPECT_EQ(assess(f).verdict, Verdict::sound);
  f.energy.kinetic = 0.011 * 5e3;
  EXPECT_EQ(assess(f).verdict, Verdict::doubtful);
}

TEST(Checks, FrictionIsNotMissedInASlideThatHardlyMoved) {
  RunFacts f = facts();
  f.least_friction = 0.5;
  f.weight = 1e4;
  f.travel = 0.99 * f.dx;
  EXPECT_EQ(assess(f).verdict, Verdict::sound);
  f.travel = 1.01 * f.dx;
  EXPECT_EQ(assess(f).verdict, Verdict::doubtful);
}

TEST(Checks, RowsAcrossAreThoseOfTheThickestPlace) {
  std::vector<Vec2> points;
  const auto add = [&](double x, int nx, double y, int ny) {
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j) points.push_back({x + 0.5 * (i + 0.5), y + 0.5 * (j + 0.5)});
  };
  add(-3.0, 40, 2.0, 3);
  EXPECT_EQ(rows_across(points, 0.5), 3.0) << "a sheet";
  add(2.0, 4, 3.5, 2);
  EXPECT_EQ(rows_across(points, 0.5), 5.0) << "with a heap";
  EXPECT_EQ(rows_across({}, 0.5), 0.0);
}

TEST(Checks, TheFixedStepIsComparedWithTheLimitOfItsIntegrator) {
  Model m = collapse(0.05);
  const StepBounds bounds = step_bounds(m, flow_constants(m));
  const std::vector<Vec2> one{{0.1, 0.1}};
  for (const auto& [integrator, limit] : {std::pair{Integrator::rk2, 0.8}, std::pair{Integrator::leapfrog, 0.4}}) {
    m.numerics.integrator = integrator;
    EXPECT_FALSE(facts_before_run(m, one).courant);
    for (const double factor : {0.99, 1.01}) {
      Model fixed = m;
      fixed.time.fixed_step = factor * limit * bounds.h / bounds.c;
      RunFacts f = facts_before_run(fixed, one);
      f.rows.reset();
      EXPECT_EQ(assess(f).verdict, factor < 1.0 ? Verdict::sound : Verdict::doubtful);
    }
  }
}

}  // namespace
}  // namespace talus

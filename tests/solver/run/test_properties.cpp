#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "case/load.hpp"
#include "run/realization.hpp"
#include "simulation/simulation.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

/// A slope of one soil with these properties.
Case slope_of(const Json& properties, std::vector<std::string> changes = {}) {
  const Json document = {
      {"title", "slope"},
      {"particle_spacing_m", 0.5},
      {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
      {"slide", {{"outlines", {{{"outline_m", {{0, 4}, {8, 0}, {10, 0}, {4, 7}, {0, 7}}}}}}}},
      {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}, {"cohesion_kPa", 2}, {"viscosity_Pa_s", 500}}},
      {"time", {{"end_s", 3}}},
      {"random_field", {{"correlation_length_m", 3}, {"terms", 12}, {"properties", properties}}}};
  return load_case(document, "", changes).value;
}

Strength soil_of(const Case& c, std::optional<std::int64_t> realization) {
  return strength(c.model, c.field, c.study, plan_particles(c.model), {.seed = 3, .realization = realization});
}

/// Digest of the state after some steps.
std::string digest_of(const Case& c, std::optional<std::int64_t> realization, int steps = 60) {
  const ParticlePlan plan = plan_particles(c.model);
  const Strength soil = strength(c.model, c.field, c.study, plan, {.seed = 3, .realization = realization});
  Simulation s(soil.model, plan, soil.properties);
  for (int k = 0; k < steps; ++k) s.step(c.model.time.end);
  return s.result().digest;
}

const Json all_constant = {{"friction", {{"marginal", "constant"}, {"mean_deg", 25}}},
                           {"cohesion", {{"marginal", "constant"}, {"mean_kPa", 2}}},
                           {"viscosity", {{"marginal", "constant"}, {"mean_Pa_s", 500}}}};

// Constant properties are the material's to the last bit, whatever the realization; another constant is another soil.
TEST(Properties, ConstantOnesGiveTheBitsOfTheDeterministicCase) {
  Case plain = slope_of(all_constant);
  plain.field.reset();
  const std::string wanted = digest_of(plain, std::nullopt);
  EXPECT_EQ(digest_of(slope_of(all_constant), 4), wanted);
  for (const auto& [key, mean] :
       {std::pair("friction", "mean_deg"), std::pair("cohesion", "mean_kPa"), std::pair("viscosity", "mean_Pa_s")}) {
    Json other = all_constant;
    other[key][mean] = 23;
    EXPECT_NE(digest_of(slope_of(other), 4), wanted) << key;
  }
}

// A value that is drawn once is the same for all particles, and has the bits of the case that states it.
TEST(Properties, OnceIsOneValueWithTheBitsOfThatValue) {
  const Case c = slope_of({{"cohesion", {{"cov", 0.4}, {"varies", "once"}}},
                           {"unit_weight", {{"cov", 0.05}, {"varies", "once"}}},
                           {"viscosity", {{"cov", 0.3}, {"varies", "once"}}}});
  const Strength soil = soil_of(c, 2);
  EXPECT_TRUE(std::ranges::all_of(soil.properties.c, [&](double x) { return x == soil.properties.c.front(); }));
  EXPECT_NE(soil.properties.c.front(), 2e3);
  EXPECT_TRUE(soil.properties.rho0.empty());
  EXPECT_TRUE(soil.properties.eta.empty());
  const Material& drawn = soil.model.materials.front();
  EXPECT_NE(drawn.rho0, 2000);
  EXPECT_NE(drawn.eta, 500);
  Case stated = c;
  stated.field.reset();
  stated.model.materials.front().rho0 = drawn.rho0;
  stated.model.materials.front().eta = drawn.eta;
  stated.model.materials.front().c = soil.properties.c.front();
  EXPECT_EQ(digest_of(c, 2), digest_of(stated, std::nullopt));
}

TEST(Properties, SummarySaysWhatCameOut) {
  const Case c = slope_of({{"friction", {{"mean_deg", 30}, {"cov", 0.1}}},
                           {"cohesion", {{"marginal", "uniform"}, {"low_kPa", 1}, {"high_kPa", 4}}}});
  const FieldSummary summary = soil_of(c, 1).summary;
  ASSERT_EQ(summary.properties.size(), 2u);
  EXPECT_NEAR(summary.properties[0].mean, std::tan(M_PI / 6), 1e-12);
  EXPECT_NEAR(summary.properties[0].cov, 0.1, 1e-12);
  EXPECT_NEAR(summary.cov, 0.1, 1e-12);
  EXPECT_NEAR(summary.properties[1].mean, 2.5, 1e-12);
  EXPECT_NEAR(summary.properties[1].cov, 3 / std::sqrt(12) / 2.5, 1e-12);
  EXPECT_EQ(summary.terms, 24);
  const Strength soil = soil_of(c, 1);
  double sum = 0;
  for (const double x : soil.properties.c) sum += x / 1e3 / static_cast<double>(soil.properties.c.size());
  EXPECT_NEAR(summary.properties[1].run_mean, sum, 1e-12);
}

// The mean takes the place of the material's value for all that is said before a run, the median does not.
TEST(Properties, AStatedMeanStandsForTheMaterial) {
  EXPECT_DOUBLE_EQ(slope_of({{"cohesion", {{"mean_kPa", 7}, {"cov", 0.3}}}}).model.materials.front().c, 7e3);
  EXPECT_DOUBLE_EQ(slope_of({{"cohesion", {{"cov", 0.3}}}}).model.materials.front().c, 2e3);
  EXPECT_DOUBLE_EQ(slope_of({{"cohesion", {{"log_stdev", 0.3}}}}).model.materials.front().c, 2e3);
  EXPECT_NEAR(slope_of({{"unit_weight", {{"mean_kN_m3", 19.62}, {"cov", 0.1}}}}).model.materials.front().rho0, 2000,
              1e-9);
}

/// Clay below sand: undrained strength 6 kPa at the surface, 2 kPa more for every metre of depth.
Case clay_and_sand(const Json& field) {
  const Json document = {
      {"title", "layers"},
      {"particle_spacing_m", 0.5},
      {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
      {"slide",
       {{"outlines",
         {{{"outline_m", {{0, 4}, {4, 2}, {4, 7}, {0, 7}}}},
          {{"outline_m", {{4, 2}, {8, 0}, {10, 0}, {4, 7}}},
           {"material",
            {{"name", "clay"}, {"undrained_strength_kPa", 6}, {"undrained_strength_gradient_kPa_per_m", 2}}}}}}}},
      {"material", {{"name", "sand"}, {"density_kg_m3", 2000}, {"friction_angle_deg", 25}, {"cohesion_kPa", 2}}},
      {"time", {{"end_s", 3}}},
      {"random_field", field}};
  return load_case(document, "").value;
}

// A random strength keeps its gradient: each value is that at the surface, and grows in the same ratio as the mean.
TEST(Properties, UndrainedStrengthGrowsWithDepthAndHasNoFriction) {
  const Json cov = {{"cohesion", {{"cov", 0.3}, {"varies", "once"}}}, {"friction", {{"cov", 0.1}}}};
  const Json constant = {{"cohesion", {{"marginal", "constant"}, {"mean_kPa", 6}, {"material", "clay"}}}};
  const auto with = [](const Json& properties) {
    return Json{{"correlation_length_m", 3}, {"terms", 6}, {"properties", properties}};
  };
  const Case c = clay_and_sand(with(cov));
  const ParticlePlan plan = plan_particles(c.model);
  const SoilProperties stated = material_properties(c.model, plan), soil = soil_of(c, 2).properties;
  EXPECT_EQ(soil_of(clay_and_sand(with(constant)), 2).properties.c, stated.c);
  double ratio = 0.0, deepest = 0.0;
  for (std::size_t i = 0; i < plan.soil.size(); ++i) {
    if (plan.soil[i].material == 0) continue;
    EXPECT_EQ(soil.tan_phi[i], 0.0);
    if (ratio == 0.0) ratio = soil.c[i] / stated.c[i];
    EXPECT_NEAR(soil.c[i] / stated.c[i], ratio, 1e-12);
    deepest = std::max(deepest, stated.c[i]);
  }
  EXPECT_GT(std::abs(ratio - 1.0), 1e-3);
  EXPECT_GT(deepest, 6e3 + 2e3 * 2.0);
  const Case short_form = clay_and_sand({{"correlation_length_m", 3}, {"log_stdev", 0.2}, {"log_mean", -0.8}});
  const SoilProperties of_short = soil_of(short_form, 2).properties;
  for (std::size_t i = 0; i < plan.soil.size(); ++i) EXPECT_EQ(of_short.tan_phi[i] == 0.0, plan.soil[i].material == 1);
}

/// Mean over four realizations of the front of 99 % of the mass after 3 s [m].
double mean_front(const Json& properties) {
  const Case c = slope_of(properties);
  const ParticlePlan plan = plan_particles(c.model);
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Strength soil = strength(c.model, c.field, c.study, plan, {.seed = 3, .realization = k});
    Simulation s(soil.model, plan, soil.properties);
    while (!s.finished()) s.step(c.model.time.end);
    sum += s.result().measures.front_mass_99 / 4;
  }
  return sum;
}

// Stronger, more cohesive and more viscous soil stops nearer; heavier soil of the same cohesion runs farther. Same
// draws, mean changed; every property is a field, so that density and viscosity are those of the particles.
TEST(Properties, EachActsInItsDirection) {
  const auto front = [](const char* key, Json property) { return mean_front({{key, std::move(property)}}); };
  EXPECT_GT(front("friction", {{"mean_deg", 20}, {"cov", 0.1}}), front("friction", {{"mean_deg", 30}, {"cov", 0.1}}));
  EXPECT_GT(front("cohesion", {{"mean_kPa", 1}, {"cov", 0.3}}), front("cohesion", {{"mean_kPa", 8}, {"cov", 0.3}}));
  EXPECT_GT(front("viscosity", {{"mean_Pa_s", 300}, {"cov", 0.3}}),
            front("viscosity", {{"mean_Pa_s", 3000}, {"cov", 0.3}}));
  EXPECT_LT(front("unit_weight", {{"mean_kN_m3", 10}, {"cov", 0.05}}),
            front("unit_weight", {{"mean_kN_m3", 30}, {"cov", 0.05}}));
}

// A density that varies in space: the mass is that of the particles, and is compared with outlines of the same density.
TEST(Properties, MassAndStepFollowTheDensityOfEachParticle) {
  const Case c = slope_of({{"unit_weight", {{"cov", 0.1}}}});
  const ParticlePlan plan = plan_particles(c.model);
  const Strength soil = strength(c.model, c.field, c.study, plan, {.seed = 3, .realization = 1});
  ASSERT_EQ(soil.properties.rho0.size(), plan.soil.size());
  const Simulation s(soil.model, plan, soil.properties);
  double mass = 0.0;
  for (std::size_t i = 0; i < plan.soil.size(); ++i) mass += soil.properties.rho0[i] * 0.25 * plan.soil[i].cells;
  const SlideMass of = s.result().mass;
  EXPECT_NEAR(of.filled, mass, 1e-9 * mass);
  EXPECT_NEAR(of.filled / of.outline, slide_mass(c.model, plan).filled / slide_mass(c.model, plan).outline, 1e-12);
  const double least = std::ranges::min(soil.properties.rho0);
  const StepBounds drawn = step_bounds(soil.model, s.constants(), s.soil()),
                   mean = step_bounds(soil.model, s.constants());
  EXPECT_NEAR(drawn.c / mean.c, std::sqrt(2000 / least), 1e-12);
  EXPECT_NEAR(drawn.nu / mean.nu, 2000 / least, 1e-12);
}

// Given coefficients are used as they are, and their number is checked against all properties.
TEST(Properties, GivenCoefficients) {
  const Json two = {{"friction", {{"cov", 0.1}}}, {"cohesion", {{"cov", 0.3}, {"varies", "once"}}}};
  const Case c = slope_of(two, {"random_field.terms=2", "random_field.xi=[0.5,-1,2]"});
  const Strength soil = soil_of(c, std::nullopt);
  EXPECT_EQ(soil.xi, (std::vector<double>{0.5, -1, 2}));
  const double sigma = std::sqrt(std::log1p(0.09));
  EXPECT_NEAR(soil.properties.c.front(), 2e3 * std::exp(2 * sigma - sigma * sigma / 2), 1e-9);
  try {
    slope_of(two, {"random_field.terms=2", "random_field.xi=[0.5,-1]"});
    ADD_FAILURE();
  } catch (const ConfigError& e) {
    EXPECT_EQ(e.faults.front().pointer, "/random_field/xi");
    EXPECT_NE(e.faults.front().message.find("take 3"), std::string::npos) << e.what();
  }
}

// Without a field in space there is no correlation length to state, and nothing that it must resolve.
TEST(Properties, NumbersAloneNeedNoCorrelationLength) {
  const Json once = {{"friction", {{"cov", 0.1}, {"varies", "once"}}}};
  const Case c = slope_of(once, {"random_field.correlation_length_m=null"});
  EXPECT_EQ(soil_of(c, 0).summary.terms, 1);
  EXPECT_EQ(soil_of(c, 0).summary.captured_variance, 1.0);
}

}  // namespace
}  // namespace talus

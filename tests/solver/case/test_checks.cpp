#include <gtest/gtest.h>

#include <cmath>

#include "documents.hpp"
#include "schema_check.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::minimal;
using test::with;

bool sound(const Json& document) { return faults_of(document).empty(); }

TEST(Checks, HalfASpacingBelowTheBedIsTolerated) {
  // The vertex at (8, y) stands over the bed's height 1; the bed falls by 1 in 2.
  const auto sunk = [](double depth) { return with("/slide/outlines/0/outline_m/1", {8, 1.0 - depth}); };
  const double across = std::cos(std::atan(0.5));
  EXPECT_TRUE(sound(sunk(0.24 / across)));
  EXPECT_FALSE(sound(sunk(0.26 / across)));
}

TEST(Checks, OverlapBelowOneCellIsTolerated) {
  const auto layered = [](double bottom) {
    Json document = minimal();
    document["slide"]["outlines"].push_back({{"outline_m", {{0, bottom}, {4, bottom}, {4, 9}, {0, 9}}}});
    return document;
  };
  EXPECT_TRUE(sound(layered(8.0)));
  EXPECT_TRUE(sound(layered(7.95)));   // 4 * 0.05 = 0.2 m2 < 0.25 m2
  EXPECT_FALSE(sound(layered(7.93)));  // 0.28 m2
}

TEST(Checks, SuggestedSpacingFits) {
  const auto faults = faults_of(with("/particle_spacing_m", 0.01, with("/max_particles", 10'000)));
  ASSERT_EQ(faults.size(), 1u);
  const auto at = faults[0].find("a spacing from ");
  ASSERT_NE(at, std::string::npos) << faults[0];
  const double spacing = std::stod(faults[0].substr(at + 15));
  EXPECT_TRUE(sound(with("/particle_spacing_m", 1.01 * spacing, with("/max_particles", 10'000))));
  EXPECT_FALSE(sound(with("/particle_spacing_m", 0.99 * spacing, with("/max_particles", 10'000))));
}

TEST(Checks, NoSpacingIsSuggestedThatLosesTheSlide) {
  const auto faults = faults_of(with("/particle_spacing_m", 0.1, with("/max_particles", 100)));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("m on fits, but is too coarse for the slide: raise max_particles"), std::string::npos)
      << faults[0];
  EXPECT_EQ(faults_of(with("/particle_spacing_m", 0.01, with("/max_particles", 10'000)))[0].find("raise"),
            std::string::npos);
}

TEST(Checks, WallLayersFillTheSupport) {
  const auto layers = [](double ratio, int n) {
    return with("/numerics/smoothing_ratio", ratio, with("/walls/layers", n));
  };
  EXPECT_TRUE(sound(layers(1.2, 2)));   // 2 * 1.2 - 0.5 = 1.9
  EXPECT_FALSE(sound(layers(1.3, 2)));  // 2.1
  EXPECT_TRUE(sound(layers(2.0, 4)));
}

TEST(Checks, TheCourantNumberIsThatOfAStableIntegrator) {
  const auto faults = [](double cfl, const char* integrator) {
    return faults_of(with("/numerics/cfl", cfl, with("/numerics/integrator", integrator)));
  };
  EXPECT_TRUE(faults(0.8, "rk2").empty());
  EXPECT_TRUE(faults(0.4, "leapfrog").empty());
  ASSERT_EQ(faults(0.81, "rk2").size(), 1u);
  EXPECT_EQ(faults(0.81, "rk2")[0],
            "/numerics/cfl: 0.81 is too large for integrator \"rk2\": allowed > 0 and <= 0.8; measured on slopes, the "
            "deposit begins to shake a little above");
  ASSERT_EQ(faults(0.41, "leapfrog").size(), 1u);
  EXPECT_NE(faults(0.41, "leapfrog")[0].find("integrator \"leapfrog\": allowed > 0 and <= 0.4"), std::string::npos);
  EXPECT_TRUE(sound(with("/numerics/cfl", 0.8))) << "then rk2 is the default";
  EXPECT_FALSE(sound(with("/numerics/cfl", 0.81)));
}

TEST(Checks, TheLeapfrogIsTheDefaultWhereItRestsAsStillAsTheMidpointRule) {
  const auto chosen = [](const char* pointer, const Json& value) {
    return test::load(with(pointer, value)).value.model.numerics.integrator;
  };
  EXPECT_EQ(chosen("/numerics/cfl", 0.4), Integrator::leapfrog);
  EXPECT_EQ(chosen("/numerics/cfl", 0.41), Integrator::rk2);
  EXPECT_EQ(chosen("/numerics/density_filter", "shepard"), Integrator::rk2);
  EXPECT_EQ(chosen("/numerics/density_filter", "none"), Integrator::rk2);
  EXPECT_EQ(chosen("/rheology/yield", "regularized"), Integrator::rk2);
  EXPECT_EQ(chosen("/time/fixed_step_s", 1e-4), Integrator::rk2);
  EXPECT_EQ(chosen("/numerics/integrator", "rk2"), Integrator::rk2);
}

TEST(Checks, TheSchemaKnowsTheLimitsOfTheCourantNumber) {
  const test::SchemaCheck schema("case");
  const auto complaint = [&](double cfl, const char* integrator) {
    Json document = with("/numerics/cfl", cfl);
    if (integrator) document["numerics"]["integrator"] = integrator;
    return schema.complaint(nlohmann::json(document));
  };
  EXPECT_EQ(complaint(0.8, nullptr), "");
  EXPECT_EQ(complaint(0.8, "rk2"), "");
  EXPECT_EQ(complaint(0.4, "leapfrog"), "");
  EXPECT_NE(complaint(0.81, nullptr), "");
  EXPECT_NE(complaint(0.81, "rk2"), "");
  EXPECT_NE(complaint(0.41, "leapfrog"), "");
}

TEST(Warnings, AnOpenEndWithinReach) {
  // Crest (5, 8) at 30 deg reaches y = 0 at x = 5 + 8/tan(30 deg) = 18.86.
  const auto far = test::load(with("/terrain/bed_m/2", {19, 0}));
  EXPECT_TRUE(far.warnings.empty());
  const auto near = test::load(with("/terrain/bed_m/2", {18, 0}));
  ASSERT_EQ(near.warnings.size(), 1u);
  EXPECT_EQ(near.warnings[0].pointer, "/terrain/right_end");
  EXPECT_TRUE(test::load(with("/terrain/right_end", "wall", with("/terrain/bed_m/2", {18, 0}))).warnings.empty());
}

// A block of 3 m on flat ground, frictionless: 2 c carries its weight of 58.9 kPa from c = 29.4 kPa on.
TEST(Warnings, ASlideThatHangsInTheAir) {
  const auto raised = [](double by) {
    Json document = with("/terrain/right_end", "wall", with("/terrain/wall_top_m", 30));
    for (Json& vertex : document["slide"]["outlines"][0]["outline_m"]) vertex[1] = vertex[1].get<double>() + by;
    return test::load(document).warnings;
  };
  EXPECT_TRUE(raised(0.0).empty());
  EXPECT_TRUE(raised(0.49).empty());
  ASSERT_EQ(raised(2.0).size(), 1u);
  EXPECT_EQ(raised(2.0)[0].pointer, "/slide");
  // 2 m above a bed that falls by 1 in 2.
  EXPECT_EQ(raised(2.0)[0].message.find("hangs 1.79 m above the bed"), 0u) << raised(2.0)[0].message;
}

TEST(Warnings, SoilThatStandsByItsCohesionDoesNotLeak) {
  Json block = with("/terrain/bed_m", {{0, 0}, {100, 0}});
  block["slide"]["outlines"][0]["outline_m"] = {{40, 0}, {60, 0}, {60, 3}, {40, 3}};
  block["material"]["friction_angle_deg"] = 0;
  const auto leaks = [&](double c) { return test::load(with("/material/cohesion_Pa", c, block)).warnings.size() == 1; };
  EXPECT_FALSE(leaks(1e6));
  EXPECT_FALSE(leaks(30e3));
  EXPECT_TRUE(leaks(29e3));
  // A cut of 1 m against a wall.
  Json cut = with("/terrain/bed_m", {{0, 0}, {40, 0}}, block);
  cut["slide"]["outlines"][0]["outline_m"] = {{0, 0}, {4, 0}, {4, 1}, {0, 1}};
  EXPECT_TRUE(test::load(with("/material/cohesion_Pa", 10e3, cut)).warnings.empty());
}

TEST(Warnings, AWallLowerThanTheSlide) {
  EXPECT_EQ(test::load(with("/terrain/wall_top_m", 7)).warnings.size(), 1u);
  EXPECT_EQ(test::load(with("/terrain/wall_top_m", 8)).warnings.size(), 0u);
  const Json walled = with("/terrain/right_end", "wall");
  EXPECT_EQ(test::load(with("/terrain/wall_top_m", 7, walled)).warnings.size(), 1u) << "one key, one warning";
  const auto warnings = test::load(with("/terrain/right_wall_top_m", 7, walled)).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].pointer, "/terrain/right_wall_top_m");
}

TEST(Warnings, AHypercubeThatIsToStopEarly) {
  const Json stopping = with("/study/stop_when_ci_half_width_below_m", 0.1);
  EXPECT_TRUE(test::load(stopping).warnings.empty());
  EXPECT_EQ(test::load(with("/study/sampling", "latin_hypercube", stopping)).warnings.size(), 1u);
}

/// "pointer: message" of the only warning; "" where there is none.
std::string warning_of(const Json& document) {
  const LoadedCase loaded = test::load(document);
  EXPECT_LE(loaded.warnings.size(), 1u);
  return loaded.warnings.empty() ? "" : loaded.warnings[0].pointer + ": " + loaded.warnings[0].message;
}

TEST(Warnings, ValuesThatNoSoilHasNameTheUnitMeant) {
  struct Limits {
    const char* key;
    double usual, slip;
    const char* meant;  ///< what the warning says of the slip
  };
  const Limits all[] = {{"/material/density_kg_m3", 500, 19.4, "a unit weight in kN/m3 is given as unit_weight_kN_m3"},
                        {"/material/density_kg_m3", 5000, 1.95, "a density in t/m3 or g/cm3 is multiplied by 1000"},
                        {"/material/density_kg_m3", 2000, 5001, "(500 to 5000 kg/m3)"},
                        {"/material/cohesion_Pa", 0, 5, "a cohesion in kPa is given as cohesion_kPa"},
                        {"/material/cohesion_Pa", 50, 49.9, "cohesion_kPa"},
                        {"/material/cohesion_Pa", 5e6, 5.1e6, "(0, or 50 Pa to 5 MPa)"},
                        {"/material/friction_angle_deg", 36, 0.6, "a value in radians, or tan(phi)"},
                        {"/material/friction_angle_deg", 60, 61, "(0, or 2 to 60 deg)"},
                        {"/material/viscosity_Pa_s", 1e6, 1.1e6, "(up to 1e6 Pa s)"},
                        {"/rheology/shear_modulus_Pa", 2e7, 20, "a modulus in kPa or MPa"}};
  Json wide = with("/terrain/right_end", "wall");  // no warning of an open end at small friction angles
  for (const Limits& one : all) {
    EXPECT_EQ(warning_of(with(one.key, one.usual, wide)), "") << one.key;
    const std::string warning = warning_of(with(one.key, one.slip, wide));
    EXPECT_EQ(warning.find(one.key), 0u) << warning;
    EXPECT_NE(warning.find(one.meant), std::string::npos) << warning;
  }
}

TEST(Warnings, GrainsThatNoSoilHas) {
  const auto of_grains = [](const char* key, double value) {
    Json grains = {{"high_rate_friction_angle_deg", 40}, {"grain_diameter_m", 0.002}};
    grains[key] = value;
    return warning_of(with("/material/mu_i", grains));
  };
  EXPECT_EQ(of_grains("grain_diameter_m", 0.002), "");
  EXPECT_EQ(of_grains("grain_diameter_m", 5),
            "/material/mu_i/grain_diameter_m: 5 m is unusual for soil (0.001 mm to 0.5 m); a diameter in mm is given "
            "as grain_diameter_mm");
  EXPECT_EQ(of_grains("grain_density_kg_m3", 2.65),
            "/material/mu_i/grain_density_kg_m3: 2.65 kg/m3 is unusual for soil (1000 to 8000 kg/m3)");
}

TEST(Warnings, ALayerIsWarnedOfWhereItStands) {
  const Json layered = with("/slide/outlines/0/material", {{"density_kg_m3", 19.4}});
  EXPECT_EQ(warning_of(layered).find("/slide/outlines/0/material/density_kg_m3: 19.4 kg/m3"), 0u);
}

TEST(Warnings, FieldKeysThatTheChoicesLeaveUnused) {
  const auto unused = [](Json keys) {
    Json section = {{"correlation_length_m", 1}, {"log_stdev", 0.1}};
    section.update(keys);
    std::string pointers;
    for (const Fault& w : test::load(with("/random_field", section)).warnings) pointers += w.pointer + " ";
    return pointers;
  };
  EXPECT_EQ(unused({{"terms", 9}}), "");
  EXPECT_EQ(unused({{"truncation", "variance_share"}, {"variance_share", 0.9}}), "");
  EXPECT_EQ(unused({{"truncation", "variance_share"}, {"terms", 9}}), "/random_field/terms ");
  EXPECT_EQ(unused({{"truncation", "diagonal"}, {"variance_share", 0.9}}), "/random_field/variance_share ");
  EXPECT_EQ(unused({{"grid_spacing_m", 0.1}}), "/random_field/grid_spacing_m ");
  EXPECT_EQ(unused({{"sampler", "circulant_embedding"}, {"grid_spacing_m", 0.1}}), "");
  EXPECT_EQ(unused({{"sampler", "circulant_embedding"},
                    {"terms", 9},
                    {"variance_share", 0.9},
                    {"truncation", "diagonal"},
                    {"root_intervals", "paper"}}),
            "/random_field/terms /random_field/variance_share /random_field/truncation /random_field/root_intervals ");
}

TEST(Warnings, AResolvedCaseNamesAllKeysWithoutOne) {
  const Json section = {{"correlation_length_m", 1}, {"log_stdev", 0.1}, {"truncation", "variance_share"}};
  const LoadedCase loaded = test::load(with("/random_field", section));
  EXPECT_TRUE(test::load(loaded.resolved).warnings.empty());
}

TEST(Warnings, AFrontThatASingleRowOfParticlesMayDecide) {
  const auto warnings = [](double thickness) {
    return test::load(with("/terrain/front_thickness_m", thickness)).warnings;
  };
  EXPECT_TRUE(warnings(1.5 * 0.5).empty());
  EXPECT_TRUE(test::load(with("/particle_spacing_m", 0.4, with("/terrain/front_thickness_m", 0.6))).warnings.empty());
  ASSERT_EQ(warnings(0.7).size(), 1u);
  EXPECT_EQ(warnings(0.7)[0].pointer, "/terrain/front_thickness_m");
  EXPECT_NE(warnings(0.7)[0].message.find("0.7 m is less than 1.5 particle spacings, 0.75 m"), std::string::npos);
  EXPECT_EQ(faults_of(with("/terrain/front_thickness_m", 0)).size(), 1u);
}

}  // namespace
}  // namespace talus

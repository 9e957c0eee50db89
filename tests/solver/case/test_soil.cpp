// Undrained strength, pore pressure, softening, water and stretches of the bed: from the keys to the model.

#include <gtest/gtest.h>

#include <cmath>

#include "documents.hpp"
#include "math/angle.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::load;
using test::minimal;
using test::with;

Json clay() { return {{"density_kg_m3", 1800}, {"undrained_strength_kPa", 20}}; }

/// The case has the same hash and model when its resolved form is loaded.
LoadedCase loaded_twice(const Json& document) {
  const LoadedCase once = load(document), again = load(once.resolved);
  EXPECT_EQ(once.hash, again.hash) << once.resolved.dump(1);
  EXPECT_EQ(once.value.model, again.value.model);
  return once;
}

TEST(CaseSoil, UndrainedStrengthTakesThePlaceOfFrictionAndCohesion) {
  Json document = with("/material", clay());
  document["material"]["undrained_strength_gradient_kPa_per_m"] = 1.5;
  const LoadedCase loaded = loaded_twice(document);
  const Material& m = loaded.value.model.materials[0];
  EXPECT_TRUE(m.undrained);
  EXPECT_EQ(m.c, 20e3);
  EXPECT_EQ(m.c_gradient, 1500.0);
  EXPECT_EQ(m.phi, 0.0);
  EXPECT_FALSE(loaded.resolved["material"].contains("friction_angle_deg"));
  EXPECT_FALSE(loaded.resolved["material"].contains("cohesion_Pa"));
  EXPECT_EQ(loaded.resolved["material"]["undrained_strength_Pa"], 20e3);
}

TEST(CaseSoil, ALayerDropsWhatItWouldInheritOfTheOtherKindOfStrength) {
  Json document = minimal();
  document["material"]["cohesion_kPa"] = 3;
  document["material"]["r_u"] = 0.1;
  document["material"]["softening"] = {{"residual_cohesion_kPa", 1}, {"displacement_m", 0.1}};
  document["slide"]["outlines"][0]["material"] = {{"undrained_strength_kPa", 20}};
  const Material layer = loaded_twice(document).value.model.materials.at(1);
  EXPECT_EQ(layer.c, 20e3);
  EXPECT_EQ(layer.phi, 0.0);
  EXPECT_FALSE(layer.r_u);
  EXPECT_FALSE(layer.softening);

  document = with("/material", clay());
  document["slide"]["outlines"][0]["material"] = {{"friction_angle_deg", 25}};
  const Material sand = loaded_twice(document).value.model.materials.at(1);
  EXPECT_FALSE(sand.undrained);
  EXPECT_EQ(sand.c, 0.0) << "20 kPa were undrained strength";
  document["slide"]["outlines"][0]["material"] = {{"cohesion_kPa", 2}};
  EXPECT_EQ(faults_of(document), std::vector<std::string>{"/slide/outlines/0/material/friction_angle_deg: is missing; "
                                                          "unit deg, allowed >= 0 and <= 89"});
}

TEST(CaseSoil, ALayerInheritsWhatItDoesNotName) {
  Json document = minimal();
  document["material"]["r_u"] = 0.25;
  document["material"]["softening"] = {{"residual_friction_angle_deg", 20}, {"displacement_m", 0.1}};
  document["slide"]["outlines"][0]["material"] = {{"friction_angle_deg", 25}};
  const Material layer = loaded_twice(document).value.model.materials.at(1);
  EXPECT_EQ(layer.r_u, 0.25);
  ASSERT_TRUE(layer.softening);
  EXPECT_EQ(layer.softening->phi, radians(20));
  document["slide"]["outlines"][0]["material"] = {{"friction_angle_deg", 15}};
  EXPECT_EQ(faults_of(document),
            std::vector<std::string>{"/slide/outlines/0/material/friction_angle_deg: 15 is less than "
                                     "residual_friction_angle_deg of the default material's softening, 20; give this "
                                     "layer a softening of its own"});
}

TEST(CaseSoil, KeysOfTheOtherKindOfStrengthAreRefused) {
  for (const char* key : {"friction_angle_deg", "cohesion_Pa", "cohesion_kPa", "r_u"}) {
    Json document = with("/material", clay());
    document["material"][key] = 0.5;
    EXPECT_EQ(faults_of(document), std::vector<std::string>{"/material/" + std::string(key) +
                                                            ": is given beside undrained_strength_kPa; give one of the "
                                                            "two"});
  }
  Json document = minimal();
  document["material"]["undrained_strength_gradient_kPa_per_m"] = 1;
  EXPECT_EQ(
      faults_of(document),
      std::vector<std::string>{"/material/undrained_strength_gradient_kPa_per_m: needs undrained_strength_kPa, the "
                               "strength at the ground surface"});
  document = with("/material", clay());
  document["material"]["softening"] = {{"residual_friction_angle_deg", 0}, {"displacement_m", 1}};
  EXPECT_EQ(faults_of(document).size(), 1u);
}

TEST(CaseSoil, ACaseWithoutTheNewKeysKeepsItsHash) {
  EXPECT_EQ(load(minimal()).resolved["material"].size(), 5u) << load(minimal()).resolved["material"].dump();
  EXPECT_FALSE(load(minimal()).resolved.contains("water"));
  EXPECT_FALSE(load(minimal()).resolved["walls"].contains("stretches"));
}

TEST(CaseSoil, WaterReachesTheModelInLocalCoordinatesToo) {
  const auto water = [](double east) {
    Json document = minimal();
    document["terrain"]["bed_m"] = {{east, 5}, {east + 10, 0}, {east + 40, 0}};
    document["slide"]["outlines"][0]["outline_m"] = {
        {east, 5}, {east + 10, 0}, {east + 12, 0}, {east + 5, 8}, {east, 8}};
    document["water"] = {{"phreatic_line_m", {{east - 1, 7}, {east + 13, -2}}}, {"unit_weight_kN_m3", 9.81 * 1.1}};
    document["walls"] = {{"stretches", {{{"x_m", {east + 11, east + 20}}, {"friction_angle_deg", 12}}}}};
    return loaded_twice(document).value.model;
  };
  const Model near = water(0.0), far = water(600000.0);
  EXPECT_NEAR(near.water.density, 1100.0, 1e-9);
  EXPECT_EQ(near.water.line, far.water.line);
  EXPECT_EQ(near.boundaries[0].stretches, far.boundaries[0].stretches);
}

TEST(CaseSoil, StretchesHaveTheirFrictions) {
  Json document = minimal();
  document["walls"] = {{"stretches",
                        {{{"x_m", {5, 8}}, {"friction_angle_deg", 12}, {"cohesion_kPa", 1}},
                         {{"x_m", {8, 20}}, {"friction_angle_deg", 20}, {"voellmy_xi_m_s2", 500}}}}};
  const std::vector<WallStretch> found = loaded_twice(document).value.model.boundaries[0].stretches;
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0], (WallStretch{5, 8, radians(12), 1000.0, {}}));
  EXPECT_EQ(found[1], (WallStretch{8, 20, radians(20), {}, 500.0}));
}

TEST(CaseSoil, AFieldPassesUndrainedLayersOver) {
  Json document = minimal();
  document["slide"]["outlines"][0]["material"] = clay();
  document["random_field"] = {{"correlation_length_m", 2}, {"log_stdev", 0.2}};
  EXPECT_EQ(faults_of(document), std::vector<std::string>{});
  document["material"] = clay();
  EXPECT_EQ(faults_of(document), std::vector<std::string>{"/random_field: varies the friction angle, and every "
                                                          "material is undrained, which has none"});
}

TEST(CaseSoil, AWaterLineThatNoMaterialFeelsIsWarnedOf) {
  Json document = with("/water", {{"phreatic_line_m", {{-1, 7}, {13, -2}}}});
  const auto warned = [](const Json& d) {
    return std::ranges::any_of(load(d).warnings, [](const Fault& f) { return f.pointer == "/water"; });
  };
  EXPECT_FALSE(warned(document));
  document["material"]["r_u"] = 0.1;
  EXPECT_TRUE(warned(document));
}

}  // namespace
}  // namespace talus

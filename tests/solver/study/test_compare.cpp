// Whether two studies can be paired: everything that makes their draws, and the message that names what differs.
#include <gtest/gtest.h>

#include "study/compare.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

const Json field = Json::parse(R"({
  "correlation_length_m": 4, "sampler": "circulant_embedding", "data": [[1, 2, 25, 1]],
  "properties": {"friction": {"cov": 0.1, "layers": "independent"}, "cohesion": {"cov": 0.3}},
  "correlation": [{"between": ["friction", "cohesion"], "value": -0.4}]})");

/// A resolved case with this field; `changes` maps pointers to values.
Json case_with(const Json& changes = Json::object()) {
  Json document = {
      {"particle_spacing_m", 0.5},
      {"material", {{"name", "upper"}, {"friction_angle_deg", 25}}},
      {"slide",
       {{"outlines",
         {{{"outline_m", {{0, 0}, {4, 0}, {4, 4}}}},
          {{"outline_m", {{4, 0}, {8, 0}, {4, 4}}}, {"material", {{"name", "lower"}, {"friction_angle_deg", 20}}}}}}}},
      {"random_field", field}};
  for (const auto& [pointer, value] : changes.items()) document[Json::json_pointer(pointer)] = value;
  return document;
}

/// "pointer: message" of the only fault; empty where the studies are paired.
std::string refusal(const Json& in_b, std::uint64_t seed = 1) {
  Tables a, b;
  a.plan.seed = 1;
  b.plan.seed = seed;
  try {
    comparison(a, b, case_with(), case_with(in_b));
  } catch (const ConfigError& e) {
    EXPECT_EQ(e.faults.size(), 1u);
    return e.faults.front().pointer + ": " + e.faults.front().message;
  }
  return {};
}

TEST(Compare, StudiesOnTheSameDrawsArePaired) {
  EXPECT_EQ(refusal({}), "");
  EXPECT_EQ(refusal({{"/material/friction_angle_deg", 24}, {"/targets", {{{"name", "wall"}}}}}), "");
}

TEST(Compare, WhatMakesTheDrawsMustBeEqualAndIsNamed) {
  const auto names = [](const std::string& message, const std::string& what) {
    EXPECT_EQ(message.substr(0, what.size()), what);
  };
  names(refusal({}, 2), ": the studies cannot be paired, since their draws differ: the seed is 1 in the first and 2");
  names(refusal({{"/random_field/properties/cohesion/cov", 0.2}}), "/random_field/properties/cohesion/cov: differs");
  names(refusal({{"/random_field/data/0/2", 26}}), "/random_field/data/0/2: differs");
  names(refusal({{"/random_field/correlation/0/value", -0.3}}), "/random_field/correlation/0/value: differs");
  // The field stands on the box of the slide, whatever the sampler.
  names(refusal({{"/slide/outlines/0/outline_m/0/0", -1}}), "/slide/outlines/0/outline_m/0/0: differs");
}

TEST(Compare, IndependentLayersMustBeTheSameOnes) {
  const Json other = {{"/slide/outlines/1/material/name", "clay"}};
  EXPECT_EQ(refusal(other).substr(0, 16), "/slide/outlines:");
  EXPECT_NE(refusal(other).find("upper, lower in the first and upper, clay in the second"), std::string::npos)
      << refusal(other);
  Tables tables;
  Json a = case_with(), b = case_with(other);
  for (Json* of : {&a, &b}) (*of)["random_field"]["properties"]["friction"]["layers"] = "one_field";
  EXPECT_NO_THROW(comparison(tables, tables, a, b));
}

TEST(Compare, NoiseOfANuggetFollowsTheParticles) {
  Tables tables;
  Json a = case_with({{"/random_field/nugget", 0.2}}), b = a;
  b["particle_spacing_m"] = 0.25;
  EXPECT_THROW(comparison(tables, tables, a, b), ConfigError);
}

}  // namespace
}  // namespace talus

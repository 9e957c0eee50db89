#include <gtest/gtest.h>

#include "documents.hpp"

namespace talus {
namespace {

using test::minimal;

/// A case with every coordinate that it can have.
Json slope() {
  Json document = minimal();
  document["terrain"]["wall_top_m"] = 11;
  document["terrain"]["left_wall_top_m"] = 12;
  document["terrain"]["right_end"] = "wall";
  document["terrain"]["right_wall_top_m"] = 9;
  document["terrain"]["measured_from_m"] = 1.25;
  document["random_field"] = {
      {"correlation_length_m", 2}, {"log_stdev", 0.1}, {"domain_m", {{"x", {-1, 12}}, {"y", {0, 8.5}}}}};
  return document;
}

void move(Json& points, Vec2 by) {
  for (Json& p : points) p = {p[0].get<double>() + by.x, p[1].get<double>() + by.y};
}

Json moved(Json document, Vec2 by) {
  Json& terrain = document["terrain"];
  move(terrain["bed_m"], by);
  for (Json& part : document["slide"]["outlines"]) move(part["outline_m"], by);
  for (const char* top : {"wall_top_m", "left_wall_top_m", "right_wall_top_m"})
    terrain[top] = terrain[top].get<double>() + by.y;
  terrain["measured_from_m"] = terrain["measured_from_m"].get<double>() + by.x;
  Json& domain = document["random_field"]["domain_m"];
  for (Json& x : domain["x"]) x = x.get<double>() + by.x;
  for (Json& y : domain["y"]) y = y.get<double>() + by.y;
  return document;
}

TEST(LocalCoordinates, OfACaseNearZeroAreItsOwn) {
  const Json document = moved(slope(), {123.5, -77.25});
  EXPECT_EQ(test::load(document).value.model.terrain.origin, Vec2{});
  EXPECT_EQ(test::load(document).value.model.terrain.bed[1], (Vec2{133.5, -77.25}));
}

TEST(LocalCoordinates, ACaseOnANationalGridIsTheSameToTheLastBit) {
  const Case here = test::load(slope()).value;
  for (const Vec2 by : {Vec2{2'683'000, 1'247'000}, Vec2{32'412'345, 5'318'765}, Vec2{-5'000'001, 0}, Vec2{0, 1234.5},
                        Vec2{512'345.678901, -77'000.25}}) {
    Case there = test::load(moved(slope(), by)).value;
    EXPECT_EQ(there.model.terrain.origin, by);
    there.model.terrain.origin = {};
    EXPECT_EQ(there.model, here.model) << by.x << " " << by.y;
    EXPECT_EQ(there.field, here.field) << by.x << " " << by.y;
  }
}

TEST(LocalCoordinates, VerticesWithinAMicrometreBecomeOne) {
  Json document = moved(slope(), {2'683'000, 1'247'000});
  Json& bed = document["terrain"]["bed_m"];
  bed.insert(bed.begin() + 2, Json::array({2'683'010.0000001, 1'247'000}));
  EXPECT_EQ(test::load(document).value.model.terrain.bed.size(), 3u);
}

TEST(LocalCoordinates, TheResolvedCaseAndTheMessagesAreInThoseOfTheCase) {
  const Vec2 by{2'683'000, 1'247'000};
  const Json document = moved(slope(), by);
  const LoadedCase loaded = test::load(document);
  EXPECT_EQ(loaded.resolved["terrain"]["bed_m"], document["terrain"]["bed_m"]);
  EXPECT_EQ(loaded.resolved["terrain"]["measured_from_m"], 1.25 + by.x);
  EXPECT_EQ(test::load(loaded.resolved).resolved, loaded.resolved);
  Json below = document;
  below["slide"]["outlines"][0]["outline_m"][1][1] = by.y - 3;
  const std::vector<std::string> faults = test::faults_of(below);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("(2683010, 1246997)"), std::string::npos) << faults[0];
}

TEST(LocalCoordinates, ASectionOfThousandsOfKilometresIsRefused) {
  Json document = slope();
  document["terrain"]["bed_m"][2][0] = 2'683'000;
  const std::vector<std::string> faults = test::faults_of(document);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("at most 2e+06 m are allowed"), std::string::npos) << faults[0];
}

}  // namespace
}  // namespace talus

// Targets of a case: where they may stand, and what the flow sees of them.

#include <gtest/gtest.h>

#include "documents.hpp"
#include "simulation/flow_at.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::load;
using test::with;
using Lines = std::vector<std::string>;

/// The minimal case with targets; its slide reaches from x = 0 to 12, its bed to 40, the spacing is 0.5 m.
Json case_with(const char* targets) { return with("/targets", Json::parse(targets)); }

TEST(Targets, AreReadInTheirThreeForms) {
  const Model m = load(case_with(R"([{"name": "a", "point_m": [20]},
                                     {"name": "sill", "point_m": [20, 1.25]},
                                     {"name": "road", "stretch_m": [30, 36.5]},
                                     {"name": "Haus 7-b", "structure": {"x_m": [22, 25], "height_m": 4}}])"))
                      .value.model;
  ASSERT_EQ(m.targets.size(), 4u);
  EXPECT_EQ(m.targets[0], (Target{.of = {"a", TargetKind::point}, .from = 20, .to = 20, .threshold = 0.75}));
  EXPECT_EQ(m.targets[1].threshold, 1.25) << "reached when the flow reaches up to y";
  EXPECT_EQ(m.targets[2], (Target{.of = {"road", TargetKind::stretch}, .from = 30, .to = 36.5, .threshold = 0.75}));
  ASSERT_EQ(m.boundaries.size(), 2u);
  const Target& house = m.targets[3];
  EXPECT_EQ(house.structure->boundary, 1);
  EXPECT_EQ(house.structure->foot, (Vec2{25, 0}));
  EXPECT_NEAR(house.structure->averaging, 0.05 * std::sqrt(2 * 8 / 9.81), 1e-12);
  EXPECT_EQ(house.from, 22 - target_reach(0.5));
  EXPECT_EQ(m.boundaries[1].name, "Haus 7-b");
  EXPECT_EQ(m.boundaries[1].line.vertices, (std::vector<Vec2>{{22, -1.5}, {22, 4}, {25, 4}, {25, -1.5}}));
  EXPECT_TRUE(m.boundaries[1].line.closed);
}

TEST(Targets, AStructureHasTheSlipAndStrengthOfTheWalls) {
  Json document = case_with(R"([{"name": "wall", "structure": {"outline_m": [[25, -1], [25, 3], [22, 3], [22, -1]],
                                 "averaging_time_s": 0.2}}])");
  document["walls"] = {{"slip", "friction"}, {"friction_angle_deg", 20}};
  const Model m = load(document).value.model;
  EXPECT_EQ(m.boundaries[1].slip, WallSlip::friction);
  EXPECT_EQ(m.boundaries[1].phi, m.boundaries[0].phi);
  EXPECT_LT(m.boundaries[1].line.vertices[1].x, m.boundaries[1].line.vertices[2].x) << "the soil is not outside";
  EXPECT_EQ(m.targets[0].structure->averaging, 0.2);
}

TEST(Targets, OfASlideToTheLeftHaveTheirFootOnTheLeft) {
  Json document = case_with(R"([{"name": "w", "structure": {"x_m": [-25, -22], "height_m": 2}}])");
  document["terrain"]["bed_m"] = {{-40, 0}, {-10, 0}, {0, 5}};
  document["slide"]["outlines"][0]["outline_m"] = {{0, 5}, {-10, 0}, {-12, 0}, {-5, 8}, {0, 8}};
  const Target target = load(document).value.model.targets[0];
  EXPECT_EQ(target.structure->foot, (Vec2{-25, 0}));
  EXPECT_EQ(target.from, -22 + target_reach(0.5));
}

TEST(Targets, StandWhereTheyStandOnANationalGrid) {
  const char* targets = R"([{"name": "w", "structure": {"x_m": [22, 25], "height_m": 2}}])";
  const Model here = load(case_with(targets)).value.model;
  Json document = case_with(R"([{"name": "w", "structure": {"x_m": [2600022, 2600025], "height_m": 2}}])");
  for (Json* list : {&document["terrain"]["bed_m"], &document["slide"]["outlines"][0]["outline_m"]})
    for (Json& vertex : *list) vertex = {vertex[0].get<double>() + 2600000, vertex[1].get<double>() + 700};
  const Model there = load(document).value.model;
  EXPECT_EQ(there.targets, here.targets);
  EXPECT_EQ(there.boundaries, here.boundaries);
}

TEST(Targets, DecideTheRunsOnlyWhereThereAreAny) {
  EXPECT_EQ(load(case_with("[]")).hash, load(test::minimal()).hash);
  EXPECT_FALSE(load(case_with("[]")).resolved.contains("targets"));
  EXPECT_NE(load(case_with(R"([{"name": "a", "point_m": [20]}])")).hash, load(test::minimal()).hash);
}

TEST(Targets, HaveNamesOfTheirOwn) {
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "point_m": [20]}, {"name": "a", "point_m": [21]}])")),
            Lines{"/targets/1/name: is that of /targets/0 too; give each target a name of its own"});
  for (const char* name : {"a,b", "a.b", " a", "a=b", "a\nb", ""}) {
    const Lines faults = faults_of(with("/targets", {{{"name", name}, {"point_m", {20}}}}));
    ASSERT_EQ(faults.size(), 1u) << name;
    EXPECT_EQ(faults[0].find("/targets/0/name: "), 0u) << faults[0];
  }
}

TEST(Targets, HaveOnePlace) {
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a"}])")),
            Lines{"/targets/0: has no place; give point_m, stretch_m or structure"});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "point_m": [20], "stretch_m": [20, 21]}])")),
            Lines{"/targets/0: has several places; give one of point_m, stretch_m and structure"});
  EXPECT_EQ(
      faults_of(case_with(R"([{"name": "a", "point_m": []}])")),
      Lines{"/targets/0/point_m: [] is not a list of 1 to 2 numbers; each unit m, allowed >= -1e+08 and <= 1e+08"});
  EXPECT_EQ(
      faults_of(case_with(R"([{"name": "a", "stretch_m": [20]}])")),
      Lines{"/targets/0/stretch_m: [20] is not a list of 2 numbers; each unit m, allowed >= -1e+08 and <= 1e+08"});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "structure": {"x_m": [20, 22]}}])")),
            Lines{"/targets/0/structure/height_m: is missing"});
}

TEST(Targets, AreOnTheTerrainAndNotOnTheSlide) {
  const char* off = "lies off the terrain, which reaches from x = 0 to 40";
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "point_m": [41]}])")),
            Lines{std::string("/targets/0/point_m: ") + off});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "stretch_m": [38, 41]}])")),
            Lines{std::string("/targets/0/stretch_m: ") + off});
  const char* on = "lies on the slide, which reaches from x = 0 to 12; a target is a place that the slide may reach";
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "point_m": [11]}])")),
            Lines{std::string("/targets/0/point_m: ") + on});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "structure": {"x_m": [11, 14], "height_m": 3}}])")),
            Lines{std::string("/targets/0/structure/x_m: ") + on});
  EXPECT_EQ(
      faults_of(case_with(R"([{"name": "a", "point_m": [20, -0.75]}])")),
      Lines{"/targets/0/point_m: lies 0.75 m below the ground, whose height there is 0; half a particle spacing is "
            "tolerated"});
}

TEST(Targets, HaveAnExtentThatTheParticlesSee) {
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "stretch_m": [22, 21]}])")),
            Lines{"/targets/0/stretch_m: has no extent: give [x1, x2] with x1 < x2"});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "structure": {"x_m": [22, 22], "height_m": 3}}])")),
            Lines{"/targets/0/structure/x_m: has no extent: give [low, high] with low < high"});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "structure": {"x_m": [22, 23], "height_m": 3}}])")),
            Lines{"/targets/0/structure/x_m: makes a structure 1 m wide; the particles see one of at least 1.5 m "
                  "(walls.layers particle spacings), or use a smaller spacing"});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "structure": {"x_m": [22, 25], "height_m": 0.4}}])")),
            Lines{"/targets/0/structure: rises 0.4 m above the ground, less than one particle spacing of 0.5"});
}

TEST(Targets, StandOnTheGroundAndApart) {
  EXPECT_EQ(
      faults_of(case_with(R"([{"name": "a", "structure": {"outline_m": [[22, -3], [25, -3], [25, -1], [22, -1]]}}])")),
      Lines{"/targets/0/structure: lies in the ground"});
  EXPECT_EQ(
      faults_of(case_with(R"([{"name": "a", "structure": {"outline_m": [[22, 1], [25, 1], [25, 4], [22, 4]]}}])")),
      Lines{"/targets/0/structure: hangs above the ground; let its outline reach down to it"});
  EXPECT_EQ(
      faults_of(case_with(R"([{"name": "a", "structure": {"outline_m": [[22, 0], [25, 3], [25, 0], [22, 3]]}}])")),
      Lines{"/targets/0/structure/outline_m: crosses or touches itself"});
  EXPECT_EQ(faults_of(case_with(R"([{"name": "a", "structure": {"x_m": [22, 25], "height_m": 3}},
                                    {"name": "b", "structure": {"x_m": [24, 27], "height_m": 2}}])")),
            Lines{"/targets/1/structure: overlaps the structure \"a\""});
}

}  // namespace
}  // namespace talus

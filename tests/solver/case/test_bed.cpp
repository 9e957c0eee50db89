// The bed: joined from the surfaces of a slide, or given with vertical faces and overhangs.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "case/joined_bed.hpp"
#include "documents.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::with;
using Points = std::vector<Vec2>;

Points joined(const Points& ground, const Points& slip, const Points& beyond = {}, const Box& slide = {}) {
  return joined_bed(ground, slip, beyond, slide);
}

TEST(JoinedBed, IsTheLowerOfGroundAndSlipSurface) {
  EXPECT_EQ(joined({{0, 10}, {4, 10}, {10, 4}, {20, 4}}, {{4, 10}, {5, 6}, {10, 4}}),
            (Points{{0, 10}, {4, 10}, {5, 6}, {10, 4}, {20, 4}}));
  // The slip surface starts and ends in the air: it crosses the ground, y = 10 - x, at x = 2 and x = 8.
  EXPECT_EQ(joined({{0, 10}, {10, 0}}, {{1, 10}, {3, 6}, {7, 2}, {9, 2}}),
            (Points{{0, 10}, {2, 8}, {3, 6}, {7, 2}, {8, 2}, {10, 0}}));
  // It comes up for air on the way.
  EXPECT_EQ(joined({{0, 0}, {16, 0}}, {{2, 0}, {4, -2}, {8, 2}, {12, -2}, {14, 0}}),
            (Points{{0, 0}, {2, 0}, {4, -2}, {6, 0}, {10, 0}, {12, -2}, {14, 0}, {16, 0}}));
}

TEST(JoinedBed, HasAVerticalFaceWhereTheSlipSurfaceEndsBelowTheGround) {
  EXPECT_EQ(joined({{0, 10}, {20, 10}}, {{5, 8}, {10, 8}}),
            (Points{{0, 10}, {5, 10}, {5, 8}, {10, 8}, {10, 10}, {20, 10}}));
  EXPECT_EQ(joined({{0, 10}, {6, 10}, {6, 5}, {20, 5}}, {{4, 10}, {5, 4}, {8, 5}}),
            (Points{{0, 10}, {4, 10}, {5, 4}, {8, 5}, {20, 5}}))
      << "a cliff in the ground above the slip surface";
}

TEST(JoinedBed, ClosesGapsOfRounding) {
  EXPECT_EQ(joined({{0, 10}, {4, 10}, {14, 4}, {20, 4}}, {{4, 9.999}, {5, 6}, {14, 3.996}}),
            (Points{{0, 10}, {4, 9.999}, {5, 6}, {14, 3.996}, {20, 4}}));
  EXPECT_EQ(joined({{0, 10}, {14, 4}, {20, 4}}, {{7, 6.995}, {9, 5}, {14, 4}}),
            (Points{{0, 10}, {7, 6.995}, {9, 5}, {14, 4}, {20, 4}}))
      << "the end of the slip surface lies 5 mm below the middle of a segment";
}

TEST(JoinedBed, TakesTheGroundBeyondOutsideTheSlide) {
  const Points ground = {{0, 10}, {4, 10}, {10, 4}, {12, 4}}, slip = {{4, 10}, {5, 6}, {10, 4}};
  const Box slide{{4, 4}, {10, 10}};
  EXPECT_EQ(joined(ground, slip, {{12, 4}, {30, 1}}, slide),
            (Points{{0, 10}, {4, 10}, {5, 6}, {10, 4}, {12, 4}, {30, 1}}));
  EXPECT_EQ(joined(ground, slip, {{-5, 12}, {40, 3}}, slide),
            (Points{{-5, 12}, {4, 10.2}, {4, 10}, {5, 6}, {10, 4}, {10, 9}, {40, 3}}))
      << "another ground on both sides, with the slide between";
}

/// The case road-slope, and its bed as it was once joined by hand.
TEST(JoinedBed, OfTheRoadSlopeIsTheOneJoinedByHand) {
  const std::filesystem::path source = TALUS_SOURCE_DIR;
  const LoadedCase by_program = load_case(source / "solver/cases/road-slope.json");
  std::ifstream by_hand(source / "tests/solver/case/data/road-slope-bed.csv");
  Points bed;
  std::string line;
  for (std::getline(by_hand, line); std::getline(by_hand, line);) {
    std::istringstream row(line);
    char comma;
    Vec2 v;
    row >> v.x >> comma >> v.y;
    bed.push_back(v);
  }
  ASSERT_EQ(bed.size(), 23u);
  EXPECT_EQ(by_program.value.model.terrain.bed, bed);
  Json document = by_program.resolved;
  document["terrain"]["bed_m"] = Json::array();
  for (const Vec2& v : bed) document["terrain"]["bed_m"].push_back({v.x, v.y});
  EXPECT_EQ(test::load(document).hash, by_program.hash);
}

/// Sections of real ground, whose beds were joined by other means; the files write millimetres.
TEST(JoinedBed, OfRealSectionsIsTheBedGivenBesideThem) {
  const std::filesystem::path sections = std::filesystem::path(TALUS_SOURCE_DIR) / "tests/validation/data/sections";
  for (const char* name : {"alpine", "hill", "ledges", "river-bank", "scarp", "valley-side"}) {
    std::ifstream file(sections / (std::string(name) + ".json"));
    Json document = Json::parse(file);
    const Points given = load_case(document, sections).value.model.terrain.bed;
    document["terrain"].erase("bed_csv");
    const Points bed = load_case(document, sections).value.model.terrain.bed;
    ASSERT_EQ(bed.size(), given.size()) << name;
    for (std::size_t k = 0; k < bed.size(); ++k) EXPECT_LT(norm(bed[k] - given[k]), 1e-3) << name << " " << k;
  }
}

Json by_surfaces() {
  Json document = test::minimal();
  document.erase("terrain");
  document["slide"] = {{"ground_surface_m", {{0, 10}, {4, 10}, {10, 4}, {40, 4}}},
                       {"slip_surface_m", {{4, 10}, {5, 6}, {10, 4}}}};
  return document;
}

TEST(Bed, IsJoinedWhereTheSlideIsGivenBySurfaces) {
  EXPECT_EQ(test::load(by_surfaces()).value.model.terrain.bed, (Points{{0, 10}, {4, 10}, {5, 6}, {10, 4}, {40, 4}}));
  const Json beyond = with("/terrain/ground_beyond_m", {{10, 4}, {50, 2}}, by_surfaces());
  EXPECT_EQ(test::load(beyond).value.model.terrain.bed, (Points{{0, 10}, {4, 10}, {5, 6}, {10, 4}, {50, 2}}));
  EXPECT_EQ(test::load(with("/terrain/bed_m", {{0, 9}, {40, 0}},
                            with("/slide/slip_surface_m", {{4, 9}, {10, 8}}, by_surfaces())))
                .value.model.terrain.bed,
            (Points{{0, 9}, {40, 0}}))
      << "a given bed is the bed";
}

TEST(Bed, IsNeededByOutlinesAndRings) {
  Json document = test::minimal();
  document["terrain"] = Json::object();
  EXPECT_EQ(faults_of(document),
            std::vector<std::string>{
                "/terrain/bed_m: is missing (or bed_csv): a slide that is given by outlines needs a bed"});
  EXPECT_EQ(
      faults_of(with("/terrain/closed", true, by_surfaces())),
      std::vector<std::string>{"/terrain/bed_m: is missing (or bed_csv): a closed bed is not joined from surfaces"});
  EXPECT_EQ(faults_of(with("/terrain/ground_beyond_m", {{10, 4}, {50, 2}})),
            std::vector<std::string>{
                "/terrain/ground_beyond_m: is given beside a bed; the bed holds the ground beyond the slide"});
}

std::string fault_of_bed(const Json& bed) {
  const auto faults = faults_of(with("/terrain/bed_m", bed, with("/terrain/left_end", "open")));
  return faults.empty() ? "" : faults[0];
}

TEST(Bed, MayHaveVerticalFacesAndOverhangs) {
  EXPECT_EQ(fault_of_bed({{0, 5}, {10, 0}, {14, 0}, {14, -4}, {40, -4}}), "");
  EXPECT_EQ(fault_of_bed({{0, 5}, {10, 0}, {14, 0}, {13, -1}, {13, -4}, {40, -4}}), "");
  EXPECT_EQ(fault_of_bed({{0, 9}, {0, 5}, {10, 0}, {40, 0}, {40, 9}}), "") << "a trough with its own walls";
  const LoadedCase overhang =
      test::load(with("/terrain/bed_m", {{0, 5}, {10, 0}, {14, 0}, {13, -1}, {13, -4}, {60, -4}}));
  ASSERT_EQ(overhang.warnings.size(), 1u);
  EXPECT_EQ(overhang.warnings[0].pointer, "/terrain/bed_m/3");
}

TEST(Bed, RunsFromItsLeftEndToItsRightEndAndKeepsClearOfItself) {
  EXPECT_NE(fault_of_bed({{0, 5}, {10, 0}, {45, 0}, {40, 1}}).find("/terrain/bed_m/2: x = 45 lies beyond an end"),
            std::string::npos);
  EXPECT_NE(fault_of_bed({{0, 5}, {-1, 4}, {40, 0}}).find("/terrain/bed_m/1: x = -1 lies beyond an end"),
            std::string::npos);
  EXPECT_NE(fault_of_bed({{40, 0}, {0, 5}}).find("lies not to the right of the first vertex"), std::string::npos);
  EXPECT_NE(fault_of_bed({{0, 5}, {20, 0}, {10, 6}, {10, 1}, {40, 0}}).find("that crosses or touches the edge"),
            std::string::npos);
  EXPECT_NE(fault_of_bed({{0, 5}, {10, 0}, {10, 0}, {40, 0}}).find("repeats the vertex"), std::string::npos);
  EXPECT_NE(fault_of_bed({{0, 5}, {0, 9}, {10, 0}, {40, 0}}).find("has no free air above"), std::string::npos)
      << "soil would be on the left of a face that goes up from the first vertex";
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include "figures/case_sheet.hpp"
#include "reading.hpp"
#include "simulation/particle_setup.hpp"

namespace talus::figures {
namespace {

using test::block;
using test::contains;

LoadedCase slope(Json bed) {
  Json document = Json::parse(R"({
    "title": "Two layers", "particle_spacing_m": 0.5,
    "slide": {"outlines": [{"outline_m": [[0, 5], [10, 0], [12, 0], [5, 8], [0, 8]]},
                           {"outline_m": [[0, 8], [5, 8], [4, 9], [0, 9]],
                            "material": {"name": "fill's", "friction_angle_deg": 22}}]},
    "material": {"name": "clay", "density_kg_m3": 2000, "friction_angle_deg": 30},
    "time": {"end_s": 5}})");
  document["terrain"]["bed_m"] = std::move(bed);
  return load_case(document, "/nonexistent");
}

std::string script_of(const LoadedCase& loaded, bool walls = false) {
  return case_sheet(loaded, report_ground(loaded), {loaded.value.title, "", ""}, walls).script.text();
}

TEST(CaseSheet, ShowsGroundMaterialsAndOpenEnds) {
  const std::string script = script_of(slope({{0, 5}, {10, 0}, {40, 0}}));
  EXPECT_EQ(block(script, "ground").size(), 3u + 1u) << "with the wall on the left";
  EXPECT_FALSE(contains(script, "as given")) << "nothing was changed";
  EXPECT_EQ(block(script, "open"), (std::vector<std::vector<double>>{{40, 0}}));
  EXPECT_TRUE(contains(script, "title 'clay'"));
  EXPECT_TRUE(contains(script, "title 'fill’s'"));
  EXPECT_FALSE(contains(script, "$walls"));
  EXPECT_FALSE(contains(script_of(slope({{0, 9}, {0, 5}, {10, 0}, {40, 0}, {40, 3}})), "$hatch <<\nEND"));
}

TEST(CaseSheet, ShowsWhatFittingChanged) {
  Json bed = {{0, 5}, {10, 0}};
  for (int k = 1; k <= 120; ++k) bed.push_back({10 + 0.25 * k, k % 2 == 0 ? 0.0 : 0.02});
  const LoadedCase loaded = slope(bed);
  const std::string script = script_of(loaded, true);
  EXPECT_EQ(block(script, "given").size(), 122u + 1u);
  EXPECT_LT(block(script, "ground").size(), 10u);
  EXPECT_EQ(block(script, "walls").size(), plan_particles(loaded.value.model).walls.size());
}

}  // namespace
}  // namespace talus::figures

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

#include "example_study.hpp"
#include "figures/charts.hpp"
#include "figures/sheet.hpp"
#include "reading.hpp"
#include "temporary_directory.hpp"

namespace talus::figures {
namespace {

using test::block;
using test::contains;
using Rows = std::vector<std::vector<double>>;

const Terrain slope{.bed = {{-5, 20}, {15, 0}, {60, 0}}, .wall_top = 25, .run_out = {-5.0}};
const std::vector<SlidePart> slide{{.outline = {{-5, 20}, {0, 15}, {0, 22}, {-5, 24}}}};

StudyFiles example(int made, bool one_failed, bool with_floor = true) {
  const test::TemporaryDirectory directory;
  test::write_example_study(directory.path(), test::example_plan(made), test::example_records(made, one_failed),
                            with_floor ? test::example_floor() : std::vector<Record>{});
  return read_study(directory.path());
}

std::vector<Sheet> all_sheets(const StudyFiles& study) {
  return {histogram_sheet(study),      exceedance_sheet(study),
          running_mean_sheet(study),   hit_probability_sheet(study, slope, slide),
          friction_angle_sheet(study), spread_sheet(study)};
}

TEST(Charts, HistogramDrawsEveryBin) {
  StudyFiles study = example(50, false);
  const Histogram& h = study.quantities.at("influence_zone_m").histogram;
  const Rows bins = block(histogram_sheet(study).script.text(), "bins");
  ASSERT_EQ(bins.size(), h.counts.size());
  double drawn = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_NEAR(bins[i][0], h.edges[i], 1e-5);
    EXPECT_NEAR(bins[i][1], h.edges[i + 1], 1e-5);
    EXPECT_EQ(bins[i][2], static_cast<double>(h.counts[i]));
    drawn += bins[i][2];
  }
  EXPECT_EQ(drawn, 50);
  study.quantities.at("influence_zone_m").histogram.counts[1] += 1;
  EXPECT_EQ(block(histogram_sheet(study).script.text(), "bins")[1][2], bins[1][2] + 1);
}

TEST(Charts, HistogramSetsSpreadAndNoiseFloorOnOneScale) {
  const StudyFiles study = example(50, false);
  const Quantity& q = study.quantities.at("influence_zone_m");
  const std::string script = histogram_sheet(study).script.text();
  EXPECT_NEAR(block(script, "strip3")[0][0], *q.mean_ci95->lo, 1e-5);
  EXPECT_NEAR(block(script, "strip3")[0][1], *q.mean_ci95->hi, 1e-5);
  EXPECT_NEAR(block(script, "strip2")[0][1] - block(script, "strip2")[0][0], 2 * *q.stdev, 1e-5);
  EXPECT_NEAR(block(script, "strip1")[0][1] - block(script, "strip1")[0][0], 2 * *q.noise_floor_stdev, 1e-5);
  EXPECT_TRUE(contains(histogram_sheet(example(50, false, false)).script.text(), "noise not measured"));
}

TEST(Charts, HistogramTellsWhatItLeavesOut) {
  StudyFiles study = example(50, false);
  study.quantities.at("influence_zone_m").histogram.overflow = 3;
  EXPECT_TRUE(contains(histogram_sheet(study).script.text(), "'3 above'"));
}

TEST(Charts, ExceedanceIsTheStudysCurve) {
  const StudyFiles study = example(20, true);
  const auto& curve = study.quantities.at("influence_zone_m").exceedance;
  const Rows rows = block(exceedance_sheet(study).script.text(), "curve");
  ASSERT_EQ(rows.size(), curve.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(rows[i][1], curve[i].p, 1e-6);
    EXPECT_LE(rows[i][2], rows[i][1]);
    EXPECT_GE(rows[i][3], rows[i][1]);
  }
}

TEST(Charts, QuantilesAreMarkedOnceFiveRunsLieBeyond) {
  EXPECT_FALSE(contains(exceedance_sheet(example(9, false)).script.text(), "half of the runs"));
  const std::string script = exceedance_sheet(example(50, false)).script.text();
  EXPECT_TRUE(contains(script, "'half of the runs: 32.45 m'"));
  EXPECT_TRUE(contains(script, "1 in 10:"));
  EXPECT_FALSE(contains(script, "1 in 100:"));
}

TEST(Charts, TheMeanOfTheFarthestParticleStandsBehindThatOfTheLeadingMeasure) {
  StudyFiles study = example(20, false);  // the front of 99 % of the mass is 0.97 of the farthest particle
  const std::string leading = "Mean: 99 % of the mass " + fixed(0.97 * 30.95, 2);
  for (const Sheet& sheet : {histogram_sheet(study), running_mean_sheet(study)}) {
    const std::string script = sheet.script.text();
    const std::size_t at = script.find(leading);
    ASSERT_NE(at, std::string::npos) << script;
    EXPECT_NE(script.find(" m, farthest particle 30.95 [", at), std::string::npos) << script;
  }
  study.quantities.erase("front_mass_99_m");
  EXPECT_TRUE(contains(histogram_sheet(study).script.text(), "Mean: farthest particle 30.95 ["));
}

// 30, 30.1, .. 31.9: the mean of the first n is 30 + (n - 1) / 20.
TEST(Charts, RunningMeanIsThatOfTheFirstN) {
  const Rows rows = block(running_mean_sheet(example(20, false)).script.text(), "means");
  ASSERT_EQ(rows.size(), 20u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i][0], static_cast<double>(i + 1));
    EXPECT_NEAR(rows[i][1], 30 + 0.05 * static_cast<double>(i), 1e-5);
  }
  // n = 2: t_{0.975,1} = 12.7062, s = 0.1 / sqrt(2), so the half width is 0.1 t / 2.
  EXPECT_NEAR(rows[1][3] - rows[1][1], 12.7062 * 0.1 / 2, 1e-4);
  EXPECT_NE(rows[0][2], rows[0][2]);  // unknown
}

TEST(Charts, RunningMeanOfManyIsThinnedButEndsAtTheLast) {
  StudyFiles study = example(3, false);
  study.realizations.assign(10'000, {0, 30.0, 25.0});
  const Rows rows = block(running_mean_sheet(study).script.text(), "means");
  EXPECT_LE(rows.size(), 400u);
  EXPECT_EQ(rows.back()[0], 10'000);
}

TEST(Charts, HitProbabilityLiesAtTheTerrainsX) {
  const StudyFiles study = example(20, false);
  const std::string script = hit_probability_sheet(study, slope, slide).script.text();
  const Rows rows = block(script, "curve");
  // Distances count from the left boundary at x = -5. The curve begins at the toe and steps down at each front, here
  // 30, 30.1, ..., 31.9; beyond the last it is 0, with an upper bound.
  double toe = -1e300;
  for (const Vec2 p : slide[0].outline) toe = std::max(toe, p.x);
  EXPECT_NEAR(rows[0][0], toe, 1e-5);
  EXPECT_EQ(rows[0][1], 1.0);
  EXPECT_NEAR(rows[1][0], 30.0 - 5.0, 1e-5);
  EXPECT_NEAR(rows[2][0], 30.0 - 5.0, 1e-5);
  EXPECT_EQ(rows[1][1], 1.0);
  EXPECT_NEAR(rows[2][1], 19.0 / 20, 1e-6);
  EXPECT_EQ(rows.back()[1], 0.0);
  EXPECT_EQ(rows.back()[2], 0.0);
  EXPECT_NEAR(rows.back()[3], *wilson(0, 20).hi, 1e-5);
  EXPECT_GT(rows.back()[0], 31.9 - 5.0 + 1.0) << "beyond the last front";
  EXPECT_EQ(block(script, "slide0").front(), (std::vector<double>{-5, 20}));
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_LE(rows[i][1], rows[i - 1][1]);
}

TEST(Charts, FrictionAngleHasOnePointARunAndTheLineOfLeastSquares) {
  const std::string script = friction_angle_sheet(example(20, true)).script.text();
  EXPECT_EQ(block(script, "runs").size(), 19u);
  EXPECT_EQ(block(script, "runs")[3], (std::vector<double>{24.7, 30.3}));
  // The example lies on zone = 30 + (25 - phi).
  for (const auto& row : block(script, "fit")) EXPECT_NEAR(row[1], 55 - row[0], 1e-5);
  EXPECT_TRUE(contains(script, "Correlation -1.00"));
}

TEST(Charts, SpreadHasEveryMeasureFromTopToBottom) {
  const StudyFiles study = example(20, false);
  const std::string script = spread_sheet(study).script.text();
  const Rows rows = block(script, "spread");
  ASSERT_EQ(rows.size(), measure_table.size());
  EXPECT_GT(rows[0][3], rows[4][3]);
  EXPECT_GT(rows[4][3], rows[5][3]);
  EXPECT_NEAR(rows[0][0], *study.quantities.at("influence_zone_m").stdev, 1e-6);
  EXPECT_NEAR(rows[4][0], *study.quantities.at("centre_of_mass_x_m").stdev, 1e-6);
  EXPECT_NEAR(block(script, "floor")[0][0], *study.quantities.at("influence_zone_m").noise_floor_stdev, 1e-6);
}

// Studies of one, of two, of equal runs, with failures, without a noise floor: all drawn, gnuplot content.
TEST(Charts, GnuplotHasNothingToSayHoweverSmallTheStudy) {
  StudyFiles equal = example(4, false);
  for (Done& r : equal.realizations) {
    r.influence_zone = 30.0;
    r.mean_phi_deg = 25.0;
  }
  for (const StudyFiles& study :
       {example(1, false, false), example(2, false), example(3, true), example(200, true), equal}) {
    for (const Sheet& sheet : all_sheets(study)) {
      EXPECT_EQ(run_gnuplot("set terminal svg noenhanced\n" + sheet.script.text()).warnings, "");
    }
  }
}

TEST(Charts, PngHasTheSizeOfTheCanvasTimesTwo) {
  const test::TemporaryDirectory directory;
  for (const Sheet& sheet : all_sheets(example(30, false))) {
    sheet.save(directory / "a.png");
    EXPECT_EQ(test::png_size(directory / "a.png"), (test::Size{static_cast<std::uint32_t>(2 * sheet.canvas.width),
                                                               static_cast<std::uint32_t>(2 * sheet.canvas.height)}));
    sheet.save(directory / "a.svg");
    // `border linecolor` would colour the border and leave the bar in gnuplot's default.
    EXPECT_FALSE(contains(sheet.script.text(), " border linecolor"));
    EXPECT_LT(std::filesystem::file_size(directory / "a.svg"), 200'000u);
  }
}

TEST(Charts, AllNameWhatMakesTheStudyDoubtful) {
  const test::TemporaryDirectory directory;
  std::vector<Record> records = test::example_records(20, false);
  for (Record& record : records) record.verdict = Verdict::sound;
  test::write_example_study(directory.path(), test::example_plan(20), records, {});
  const StudyFiles sound = read_study(directory.path());
  EXPECT_EQ(sound.quality, "");
  records[3].verdict = Verdict::doubtful;
  records[3].objections = "left_terrain: 3 of 5";
  test::write_example_study(directory.path(), test::example_plan(20), records, {});
  const StudyFiles doubtful = read_study(directory.path());
  for (const Sheet& sheet : all_sheets(doubtful))
    EXPECT_TRUE(contains(sheet.script.text(), "'1 of 20 runs doubtful: left terrain (1)' at screen"));
  for (const Sheet& sheet : all_sheets(sound)) EXPECT_FALSE(contains(sheet.script.text(), "doubtful"));
}

TEST(Charts, CountsAreToldHonestly) {
  EXPECT_EQ(count_text(example(20, false)), "20 realizations");
  EXPECT_EQ(count_text(example(20, true)), "19 of 20 realizations done, 1 failed");
}

}  // namespace
}  // namespace talus::figures

#include "cli/progress.hpp"
#include "statistics/stream.hpp"
#include "studies.hpp"

using namespace talus;
using namespace talus::cli;
using namespace talus::fixtures;

namespace {

const Progress half{.planned = 8,
                    .done = 3,
                    .failed = 1,
                    .floor_planned = 2,
                    .floor_made = 2,
                    .made_now = 6,
                    .running = 2,
                    .elapsed = 60.0,
                    .mean = 34.125,
                    .mean_half_width = 0.5};

}  // namespace

TEST(Progress, SaysWhereTheStudyStands) {
  EXPECT_EQ(progress_line({.planned = 8}), "0/8 done, 0 failed, 0 running");
  // 6 runs in 60 s: 360 an hour; 4 are left: 40 s.
  EXPECT_EQ(progress_line({.planned = 8, .running = 4, .pending_reason = "waits for rain"}),
            "0/8 done, 0 failed, 4 running, waits for rain");
  EXPECT_EQ(progress_line(half),
            "3/8 done, 1 failed, mean farthest particle 34.12 +/- 0.50 m, 40 s left, 2 running, 360/h");
  Progress regressed{.planned = 8};
  regressed.leading_mean.emplace();
  regressed.leading_mean->mean = 30.25;
  regressed.leading_mean->standard_error = 0.125;
  regressed.leading_mean->student = 2.0;
  EXPECT_EQ(progress_line(regressed),
            "0/8 done, 0 failed, 0 running; 99 % of the mass: 30.25 +/- 0.25 m by regression");
  EXPECT_FALSE(time_left({.planned = 8}));
  EXPECT_DOUBLE_EQ(*time_left(half), (8 - 3 - 1 + 2 - 2) * 60.0 / 6.0);
}

TEST(Progress, TheBarFillsAndFits) {
  EXPECT_EQ(progress_bar(half, 200).substr(0, 36), "[###############...............] 3/8");
  EXPECT_EQ(progress_bar({.planned = 4, .done = 4}, 32), "[########] 4/4 done, 0 failed, 0");
  EXPECT_EQ(progress_bar({}, 40).size(), 40u);
  EXPECT_EQ(progress_bar(half, 110).size(), 110u);  // the bar takes what the line leaves
  EXPECT_NE(progress_bar(half, 80).find("mean farthest particle 34.12 +/- 0.50 m"), std::string::npos);
}

TEST(Progress, SummaryNamesTheNumbers) {
  Plan p = plan(4);
  const std::string text = summary_table(summarize(p, {done(0, 34.0), done(1, 36.0), failed(2, "x")}, {}));
  EXPECT_NE(text.find("4 realizations planned, 2 done, 1 failed; not run yet: 3\n"), std::string::npos) << text;
  EXPECT_NE(text.find("influence_zone_m        35.000  [22.294, 47.706]"), std::string::npos) << text;
  EXPECT_LT(text.find("front_mass_99_m"), text.find("influence_zone_m")) << text;
  EXPECT_NE(text.find("\ninfluence_zone_m: the farthest particle, the paper's influence zone\n"), std::string::npos);
  EXPECT_NE(text.find("\nfront_at_thickness_m: where the deposit is 0.6 m thick\n"), std::string::npos) << text;
  EXPECT_NE(summary_table(summarize(p, {}, {})).find("0 done"), std::string::npos);
}

TEST(Progress, ReportSaysTheMeanByRegressionAndWhatMovesIt) {
  EXPECT_EQ(regression_text(summarize(plan(4), {done(0, 34.0)}, {})),
            "no mean by regression: the plan of this study does not say what is drawn\n");
  Plan p = plan(20);
  p.draws = {{"friction", 0, 5}};
  std::vector<Record> runs;
  for (std::int64_t i = 0; i < 20; ++i)
    runs.push_back(done(i, 30.0 - 2.0 * standard_normal(p.seed, static_cast<std::uint64_t>(i), 0)));
  const std::string text = regression_text(summarize(p, runs, {}));
  EXPECT_NE(text.find("\nfront_mass_99_m         29.300  [29.300, 29.300]"), std::string::npos) << text;
  EXPECT_NE(text.find("\nvariance of front_mass_99_m explained by friction 100 % [100, 100]\n"), std::string::npos);
  EXPECT_NE(text.find("m per standard deviation: friction 1 -2.000 [-2.000, -2.000]"), std::string::npos) << text;
}

TEST(Progress, HistogramInText) {
  Plan p = plan(4);
  p.study.histogram_edges = {33.0, 34.0, 35.0};
  const auto study = summarize(p, {done(0, 33.5), done(1, 34.5), done(2, 34.7), done(3, 99.0)}, {});
  EXPECT_EQ(text_histogram(study["quantities"]["influence_zone_m"], 42),
            "[       33,        34)      1 #####\n"
            "[       34,        35]      2 ##########\n"
            "above the last edge: 1\n");
  EXPECT_EQ(text_histogram(summarize(plan(4), {}, {})["quantities"]["influence_zone_m"], 42), "");
}

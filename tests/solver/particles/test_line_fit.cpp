#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "particles/ground.hpp"
#include "particles/line_fit.hpp"

namespace talus {
namespace {

/// A slope of 1:2 that runs out on a flat, one vertex every 4 cm.
Polyline survey(double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> error(0.0, 1.0);
  Polyline line;
  for (int i = 0; i <= 5000; ++i) {
    const double x = 0.04 * i;
    line.vertices.push_back({x, std::max(0.0, 40.0 - 0.5 * x) + noise * error(random)});
  }
  return line;
}

TEST(FitLine, ASurveyWithNoiseGivesTheLineWithout) {
  const double dx = 0.5;
  const Polyline truth{{{0, 40}, {80, 0}, {200, 0}}, false};
  for (const double noise : {0.0, 0.02, 0.05, 0.1}) {  // to 0.2 dx
    const FittedLine fitted = fit_line(survey(noise), dx);
    EXPECT_NEAR(fitted.noise, noise, 0.1 * noise + 1e-9) << noise;
    EXPECT_LT(fitted.line.vertices.size(), 200u) << noise;
    EXPECT_DOUBLE_EQ(fitted.line.vertices.front().x, 0.0);
    EXPECT_DOUBLE_EQ(fitted.line.vertices.back().x, 200.0);
    EXPECT_LT(fitted.line.length(), 1.02 * truth.length()) << noise;
    double mean = 0.0, square = 0.0;
    const Ground ground({truth});
    for (int i = 0; i < 1000; ++i) {
      const double e = ground.nearest(fitted.line.at(0.0001 * (i + 0.5) * fitted.line.length() * 10)).distance;
      mean += e / 1000;
      square += e * e / 1000;
    }
    EXPECT_LT(std::abs(mean), 0.1 * noise + 1e-9) << noise;  // neither higher nor lower than the truth
    EXPECT_LT(std::sqrt(square), 0.6 * noise + 1e-9) << noise;
  }
}

TEST(FitLine, WhatIsCoarserThanTheSpacingStays) {
  // A cliff, a ledge and a wall thinner than the spacing.
  const Polyline cliff{{{0, 10}, {10, 10}, {10.001, 0}, {50, 0}, {50.001, 6}, {50.3, 6}, {50.301, 0}, {90, 0}}, false};
  const FittedLine fitted = fit_line(cliff, 0.5);
  ASSERT_EQ(fitted.line.vertices.size(), cliff.vertices.size());
  for (std::size_t i = 0; i < cliff.vertices.size(); ++i) EXPECT_EQ(fitted.line.vertices[i], cliff.vertices[i]);
}

TEST(FitLine, TheFaceOfACliffInASurveyStaysWhereItIs) {
  std::mt19937 random(3);
  std::normal_distribution<double> error(0.0, 0.05);
  Polyline line;
  for (int i = 0; i < 1000; ++i) line.vertices.push_back({0.04 * i, (i < 500 ? 10.0 : 0.0) + error(random)});
  const FittedLine fitted = fit_line(line, 0.5);
  const Ground ground({fitted.line});
  EXPECT_NEAR(ground.nearest({19.98, 5.0}).distance, 0.0, 0.1);  // in the middle of the face
  EXPECT_NEAR(ground.nearest({10.0, 10.5}).distance, 0.5, 0.1);
  EXPECT_NEAR(ground.nearest({30.0, 0.5}).distance, 0.5, 0.1);
}

TEST(FitLine, ANotchTooNarrowForAParticleIsFilled) {
  const double dx = 0.5;
  const Polyline bed{{{0, 20}, {8, 20}, {8.4, 16.5}, {8.8, 20}, {20, 20}, {30, 10}, {30.2, 3}, {30.4, 10}, {50, 10}},
                     false};
  const FittedLine report = fit_line(bed, dx);
  const Polyline& fitted = report.line;
  EXPECT_EQ(report.notches, 2);
  EXPECT_EQ(report.moved, 0.0);
  EXPECT_EQ(fitted.vertices.front(), bed.vertices.front());
  EXPECT_EQ(fitted.vertices.back(), bed.vertices.back());
  const Ground ground({fitted});
  EXPECT_NEAR(report.deepest_notch, -ground.nearest({30.2, 3}).distance, 1e-12) << "the bottom of the second";
  // A disc of diameter dx touches both sides of the first notch where it is about dx wide; of the second only the
  // edges.
  EXPECT_GT(ground.nearest({8.4, 20.0}).distance, 0.0);
  EXPECT_LT(ground.nearest({8.4, 17.5}).distance, -0.5);
  EXPECT_LT(ground.nearest({30.2, 9.0}).distance, -0.5);
  for (const Vec2 v : {Vec2{4, 20}, Vec2{15, 20}, Vec2{25, 15}, Vec2{40, 10}})
    EXPECT_NEAR(ground.nearest(v).distance, 0, 0.01);
  // A valley of 100 degrees and the corner of a box stay as they are, vertex by vertex.
  const Polyline box{{{0, 30}, {0, 20}, {10, 20}, {18, 13.3}, {26, 20}, {40, 20}}, false};
  EXPECT_EQ(fit_line(box, dx).line, box);
  EXPECT_EQ(fit_line(box, dx).notches, 0);
}

TEST(FitLine, ARingStaysARing) {
  Polyline ring{{}, true};
  constexpr int n = 3000;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.141592653589793 * i / n;
    ring.vertices.push_back({5 * std::cos(angle), 5 * std::sin(angle)});
  }
  const FittedLine fitted = fit_line(ring, 0.5);
  EXPECT_TRUE(fitted.line.closed);
  EXPECT_LT(fitted.line.vertices.size(), 60u);
  EXPECT_GT(fitted.line.vertices.size(), 10u);
  for (const Vec2& v : ring.vertices) EXPECT_NEAR(Ground({fitted.line}).nearest(v).distance, 0.0, 0.05);
}

}  // namespace
}  // namespace talus

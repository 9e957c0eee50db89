// The mean by control variates: against a regression worked out by hand, on samples of known law, and how often its
// interval holds the true mean.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "statistics/controlled_mean.hpp"

namespace talus {
namespace {

using Columns = std::vector<std::vector<double>>;

/// n draws of a model of standard normal controls.
struct Draws {
  std::vector<double> y;
  Columns controls;
};
template <class Model>
Draws draws(std::size_t n, std::size_t controls, std::mt19937_64& random, Model model) {
  std::normal_distribution<double> normal;
  Draws d{.y = std::vector<double>(n), .controls = Columns(controls, std::vector<double>(n))};
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> xi(controls);
    for (std::size_t k = 0; k < controls; ++k) xi[k] = d.controls[k][i] = normal(random);
    d.y[i] = model(xi, normal(random));
  }
  return d;
}

double linear(const std::vector<double>& xi, double noise) { return 3.0 + 2.0 * xi[0] - xi[1] + 0.1 * noise; }

// y = 1, 2, 4, 5, 7 on c = -2, -1, 0, 1, 2: intercept 3.8, slope 1.5; residuals 0.2, -0.3, 0.2, -0.3, 0.2; leverages
// 0.6, 0.3, 0.2, 0.3, 0.6. HC3 of the intercept, weights 1/5: sqrt((0.5^2 + 0.4286^2 + 0.25^2 + 0.4286^2 + 0.5^2)/25).
TEST(ControlledMean, IsTheInterceptOfARegression) {
  const std::vector<double> y{1, 2, 4, 5, 7}, c{-2, -1, 0, 1, 2};
  const auto found = controlled_mean(y, Columns{c});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->slopes.size(), 1U);
  EXPECT_NEAR(found->mean, 3.8, 1e-12);
  EXPECT_NEAR(found->slopes[0].value, 1.5, 1e-12);
  const double squares = 2 * 0.25 + 2 * std::pow(0.3 / 0.7, 2) + 0.0625;
  EXPECT_NEAR(found->standard_error, std::sqrt(squares / 25), 1e-12);
  constexpr double t3 = 3.182446305284263;
  EXPECT_NEAR(*found->ci95.hi - found->mean, t3 * found->standard_error, 1e-9);
  EXPECT_NEAR(found->residual_share, (0.3 / 3) / 5.7, 1e-12);  // sum of e^2 over 3; variance of y
}

TEST(ControlledMean, TakesTheMeanOfTheControlsForZero) {
  const std::vector<double> y{6, 7, 8, 9, 10}, c{1, 2, 3, 4, 5};  // y = 5 + c, drawn far from c = 0
  EXPECT_NEAR(controlled_mean(y, Columns{c})->mean, 5.0, 1e-12);
}

TEST(ControlledMean, WithoutControlsIsThePlainMean) {
  const std::vector<double> y{1, 2, 4, 5, 7, 7, 8, 9, 9, 30};
  const auto found = controlled_mean(y, {});
  EXPECT_NEAR(found->mean, 8.2, 1e-12);
  EXPECT_TRUE(found->slopes.empty());
  EXPECT_NEAR(found->residual_share, 1.0, 1e-12);
  EXPECT_LT(found->worth, 10.0);  // HC3 is on the careful side
  EXPECT_GT(found->worth, 8.0);
}

TEST(ControlledMean, LeavesOutWhatDoesNotHelp) {
  std::mt19937_64 random(7);
  const Draws d = draws(200, 20, random, linear);
  const auto found = controlled_mean(d.y, d.controls);
  EXPECT_GE(found->slopes.size(), 2U);
  EXPECT_LE(found->slopes.size(), 8U);
  EXPECT_NEAR(found->slopes[0].value, 2.0, 5 * 0.1 / std::sqrt(200));
  EXPECT_NEAR(found->slopes[1].value, -1.0, 5 * 0.1 / std::sqrt(200));
  EXPECT_GT(found->worth, 200 * 300);  // 5.01 / 0.01 of the variance
}

TEST(ControlledMean, HasFiveValuesForEachControl) {
  std::mt19937_64 random(3);
  const Draws d = draws(14, 4, random, [](const auto& xi, double) { return 3 * xi[0] + 2 * xi[1] + 0.5 * xi[2]; });
  EXPECT_EQ(controlled_mean(d.y, d.controls)->slopes.size(), 2U);
}

TEST(ControlledMean, PassesOverWhatIsConstantOrRepeated) {
  std::mt19937_64 random(5);
  Draws d = draws(50, 2, random, linear);
  const Columns with_more{std::vector<double>(50, 1.0), d.controls[0], d.controls[0], d.controls[1]};
  const auto found = controlled_mean(d.y, with_more);
  ASSERT_EQ(found->slopes.size(), 2U);
  EXPECT_EQ(found->slopes[0].variable, 1U);
  EXPECT_EQ(found->slopes[1].variable, 3U);
}

TEST(ControlledMean, OfAConstantSampleIsExact) {
  const auto found = controlled_mean(std::vector<double>(10, 4.0), Columns{{1, -1, 1, -1, 2, 0, 1, 3, -2, 1}});
  EXPECT_NEAR(found->mean, 4.0, 1e-14);
  EXPECT_NEAR(found->standard_error, 0.0, 1e-14);
}

TEST(ControlledMean, NeedsTwoValuesAndWholeColumns) {
  EXPECT_FALSE(controlled_mean(std::vector<double>{1.0}, {}));
  EXPECT_THROW(controlled_mean(std::vector<double>{1.0, 2.0}, Columns{{1.0}}), std::invalid_argument);
}

/// How often the interval of samples of 25 holds the true mean 3: in 4,000 samples it is off by less than 0.0035 z.
template <class Model>
double coverage(Model model) {
  constexpr int samples = 4000;
  std::mt19937_64 random(11);
  int held = 0;
  for (int i = 0; i < samples; ++i) {
    const Draws d = draws(25, 8, random, model);
    const Interval ci = controlled_mean(d.y, d.controls)->ci95;
    if (*ci.lo <= 3.0 && 3.0 <= *ci.hi) ++held;
  }
  return static_cast<double>(held) / samples;
}

TEST(ControlledMean, ItsIntervalHoldsTheMeanAsOftenAsItSays) {
  const auto near95 = [](double found) { EXPECT_NEAR(found, 0.95, 0.02 + 3 * 0.0035); };
  near95(coverage(linear));
  near95(coverage([](const auto&, double noise) { return 3.0 + noise; }));
  near95(coverage([](const auto& xi, double noise) { return 3.0 + xi[0] + 0.6 * xi[3] + 0.5 * noise; }));
  near95(
      coverage([](const auto& xi, double noise) { return 3.0 + 0.5 * xi[0] + 0.4 * std::exp(0.5 * xi[0]) * noise; }));
}

}  // namespace
}  // namespace talus

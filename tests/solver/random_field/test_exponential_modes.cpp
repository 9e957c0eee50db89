#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "math/quadrature.hpp"
#include "random_field/modes.hpp"

namespace talus {
namespace {

constexpr double pi = std::numbers::pi;

struct Domain {
  double a, ell;
};
constexpr Domain domains[] = {{0.5, 1.0}, {5.0, 0.2}, {2.0, 3.0}, {10.0, 0.05}};

// Eigenvalues from the roots of the transcendental equations, SciPy 1.x brentq with xtol 1e-15.
TEST(ExponentialMode, KnownEigenvalues) {
  const double unit[] = {.738810809416, .138003775354, .045088487290, .021328931287, .012278913855};
  const double wide[] = {.3985451736, .3942419278, .3872677252, .3778986914, .3664838324};
  for (int n = 1; n <= 5; ++n) {
    EXPECT_NEAR(exponential_mode(n, 0.5, 1.0).lambda, unit[n - 1], 1e-12);
    EXPECT_NEAR(exponential_mode(n, 5.0, 0.2).lambda, wide[n - 1], 1e-10);
  }
}

// integral C(x,y) f(y) dy = lambda f(x), split at the kink y = x. Homogeneous in f, so the norm has a test of its own.
TEST(ExponentialMode, FredholmResidual) {
  for (const auto [a, ell] : domains)
    for (int n : {1, 2, 3, 4, 9, 30}) {
      const ExponentialMode mode = exponential_mode(n, a, ell);
      for (double x : {-a, -0.61 * a, 0.0, 0.17 * a, 0.83 * a, a}) {
        const auto integrand = [&](double y) { return std::exp(-std::abs(x - y) / ell) * mode.value(y); };
        const double left = integrate(integrand, -a, x, 300), right = integrate(integrand, x, a, 300);
        EXPECT_NEAR(left + right, mode.lambda * mode.value(x), 1e-12) << a << ' ' << ell << ' ' << n << ' ' << x;
      }
    }
}

TEST(ExponentialMode, Orthonormal) {
  for (const auto [a, ell] : domains)
    for (int n = 1; n <= 12; ++n)
      for (int m = 1; m <= n; ++m) {
        const ExponentialMode f = exponential_mode(n, a, ell), g = exponential_mode(m, a, ell);
        const double product = integrate([&](double x) { return f.value(x) * g.value(x); }, -a, a, 10);
        EXPECT_NEAR(product, n == m ? 1 : 0, 1e-12) << a << ' ' << ell << ' ' << n << ' ' << m;
      }
}

TEST(ExponentialMode, OneRootPerIntervalAndNoneMissing) {
  for (const auto [a, ell] : domains)
    for (int n = 1; n <= 200; ++n) {
      const ExponentialMode mode = exponential_mode(n, a, ell);
      EXPECT_GE(mode.w, (n - 1) * pi / (2 * a) * (1 - 1e-15));
      EXPECT_LE(mode.w, n * pi / (2 * a) * (1 + 1e-15));
      EXPECT_EQ(mode.cosine, n % 2 == 1);
      const double wa = mode.w * a;
      const double residual = mode.cosine ? std::cos(wa) / ell - mode.w * std::sin(wa)   // [Z20] Eq. 15
                                          : std::sin(wa) / ell + mode.w * std::cos(wa);  // [Z20] Eq. 21
      EXPECT_NEAR(residual / (1 / ell + mode.w), 0, 1e-13 * n);
    }
}

// The trace of the covariance is 2a. What N modes leave out lies between the bounds that (n-1) pi/2a <= w_n <= n pi/2a
// give.
TEST(ExponentialMode, EigenvaluesSumToTheLengthOfTheInterval) {
  constexpr int count = 20'000, far = 2'000'000;
  for (const auto [a, ell] : domains) {
    double sum = 0;
    for (int n = 1; n <= count; ++n) sum += exponential_mode(n, a, ell).lambda;
    const auto lambda_at = [&](int n) { return 2 * ell / (1 + std::pow(n * pi * ell / (2 * a), 2)); };
    double least = 0;
    for (int n = count + 1; n <= far; ++n) least += lambda_at(n);
    const double most = least + lambda_at(count) + 2 / ell * std::pow(2 * a / pi, 2) / far;
    EXPECT_GE(sum, 2 * a - most);
    EXPECT_LE(sum, 2 * a - least);
  }
}

TEST(ExponentialMode, ExtremeCorrelationLengths) {
  const ExponentialMode flat = exponential_mode(1, 1.0, 1e9);  // nearly constant: f = 1/sqrt(2a), lambda = 2a
  EXPECT_NEAR(flat.lambda, 2.0, 1e-8);
  EXPECT_NEAR(flat.value(0.9), 1 / std::sqrt(2.0), 1e-8);
  EXPECT_NEAR(exponential_mode(1, 1.0, 1e-9).lambda / 2e-9, 1, 1e-8);  // nearly white noise: lambda = 2 ell
  const ExponentialMode high = exponential_mode(100'001, 1.0, 1e6);
  EXPECT_NEAR(high.w, 100'000 * pi / 2, 1e-9);
}

TEST(ExponentialMode, AveragingFactorEqualsTheIntegral) {
  for (int n : {1, 2, 7, 20}) {
    const ExponentialMode mode = exponential_mode(n, 2.0, 0.3);
    for (double h : {0.1, 0.9})
      for (double x : {-1.5, 0.2, 1.1}) {
        const double average = integrate([&](double y) { return mode.value(y); }, x - h / 2, x + h / 2, 4) / h;
        EXPECT_NEAR(mode.averaging_factor(h) * mode.value(x), average, 1e-13);
      }
    EXPECT_EQ(mode.averaging_factor(0), 1);
  }
}

TEST(ModeNumber, PrintedIntervalsSkipEveryOtherModeOfEitherParity) {
  const int paper[] = {1, 4, 5, 8, 9, 12, 13};
  for (int i = 1; i <= 7; ++i) {
    EXPECT_EQ(mode_number(i, RootIntervals::complete), i);
    const int n = mode_number(i, RootIntervals::paper);
    EXPECT_EQ(n, paper[i - 1]);
    // [Z20] Eqs. 15, 21: [(i-1) pi/a, (i-1/2) pi/a], [(i-1/2) pi/a, i pi/a]
    const double a = 5, w = exponential_mode(n, a, 0.2).w, from = (i % 2 == 1 ? i - 1 : i - 0.5) * pi / a;
    EXPECT_GE(w, from);
    EXPECT_LE(w, from + 0.5 * pi / a);
  }
}

TEST(AxisModes, AreThoseOfTheIntervalAboutItsMiddle) {
  AxisModes axis(3.0, 7.0, 0.8, RootIntervals::complete);
  EXPECT_EQ(axis.centre(), 5.0);
  EXPECT_EQ(axis.length(), 4.0);
  EXPECT_EQ(axis[4].lambda, exponential_mode(5, 2.0, 0.8).lambda);
  EXPECT_EQ(axis.solved(1).w, exponential_mode(2, 2.0, 0.8).w);
  AxisModes printed(3.0, 7.0, 0.8, RootIntervals::paper);
  EXPECT_EQ(printed[1].lambda, exponential_mode(4, 2.0, 0.8).lambda);
}

TEST(AxisModes, ConstantAxisHasOneModeOfValueOne) {
  AxisModes axis = AxisModes::constant();
  EXPECT_TRUE(axis.has(0));
  EXPECT_FALSE(axis.has(1));
  EXPECT_EQ(axis.length(), 1);
  EXPECT_EQ(axis[0].lambda, 1);
  EXPECT_EQ(axis[0].value(123.4), 1);
  EXPECT_EQ(axis[0].averaging_factor(0.5), 1);
}

}  // namespace
}  // namespace talus

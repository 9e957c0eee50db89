#include <gtest/gtest.h>

#include <cmath>

#include "quadrature.hpp"

namespace talus {
namespace {

TEST(Integrate, ExactForDegree29AndNotBeyond) {
  const auto power = [](int n) { return [n](double x) { return std::pow(x, n); }; };
  EXPECT_NEAR(integrate(power(29), 0.0, 1.0), 1.0 / 30, 1e-15);
  EXPECT_NEAR(integrate(power(28), -1.0, 2.0), (std::pow(2.0, 29) + 1) / 29, 1e-6);
  EXPECT_GT(std::abs(integrate(power(200), -1.0, 1.0) - 2.0 / 201), 1e-5);
  EXPECT_NEAR(integrate(power(200), -1.0, 1.0, 32), 2.0 / 201, 1e-14);
}

TEST(Integrate, ManyOscillationsWithPanels) {
  const auto f = [](double x) { return std::sin(40 * x); };
  EXPECT_NEAR(integrate(f, 0.3, 5.0, 50), (std::cos(12.0) - std::cos(200.0)) / 40, 1e-13);
}

}  // namespace
}  // namespace talus

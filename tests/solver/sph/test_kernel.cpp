#include <gtest/gtest.h>

#include "sph/kernel.hpp"

namespace talus {
namespace {

template <class Kernel>
class KernelTest : public testing::Test {};
using Kernels = testing::Types<CubicSpline, WendlandC2>;
TYPED_TEST_SUITE(KernelTest, Kernels);

TYPED_TEST(KernelTest, IntegratesToOneOverThePlane) {
  const TypeParam kernel{0.37};
  const int n = 20000;
  const double dr = 2 * 0.37 / n;
  double integral = 0.0;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) * dr;
    integral += kernel.W(r * r) * 2 * std::numbers::pi * r * dr;
  }
  EXPECT_NEAR(integral, 1.0, 1e-8);
}

TYPED_TEST(KernelTest, FIsTheDerivativeOverR) {
  const TypeParam kernel{0.37};
  for (const double r : {0.05, 0.2, 0.36, 0.38, 0.5, 0.7}) {
    const double d = 1e-6;
    const double derivative = (kernel.W((r + d) * (r + d)) - kernel.W((r - d) * (r - d))) / (2 * d);
    EXPECT_NEAR(kernel.F(r * r), derivative / r, 1e-4 * std::abs(derivative / r)) << r;
  }
}

TYPED_TEST(KernelTest, VanishesOutsideTheSupport) {
  const TypeParam kernel{0.37};
  EXPECT_EQ(kernel.W(1.0001 * kernel.support2()), 0.0);
  EXPECT_EQ(kernel.F(1.0001 * kernel.support2()), 0.0);
  EXPECT_GT(kernel.W(0.99 * kernel.support2()), 0.0);
  EXPECT_LT(kernel.F(0.99 * kernel.support2()), 0.0);
}

TYPED_TEST(KernelTest, IsFiniteAtTheOrigin) {
  const TypeParam kernel{0.37};
  EXPECT_TRUE(std::isfinite(kernel.F(0.0)));
  EXPECT_GT(kernel.W(0.0), kernel.W(1e-4));
}

TEST(CubicSpline, ValuesOfMonaghanAndLattanzio) {
  const CubicSpline kernel{1.0};
  const double sigma = 15 / (7 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(kernel.W(0.0), sigma * 2 / 3);
  EXPECT_DOUBLE_EQ(kernel.W(1.0), sigma / 6);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include "sph/kernel-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;

constexpr double smoothing_length = 0.37;

/// A kernel with its normalisation.
template <class Kernel>
class KernelTest : public testing::Test {
 protected:
  const Kernel kernel{1.0 / smoothing_length};
  const double sigma = sigma_h2<Kernel>(smoothing_length) * smoothing_length * smoothing_length;
  double W(double r) const { return sigma * kernel.W(r); }
  double F(double r) const { return -sigma / (smoothing_length * smoothing_length) * kernel.minus_F(r, r * r); }
};
using Kernels = testing::Types<CubicSpline<double>, WendlandC2<double>>;
TYPED_TEST_SUITE(KernelTest, Kernels);

TYPED_TEST(KernelTest, IntegratesToOneOverThePlane) {
  const int n = 20000;
  const double dr = 2 * smoothing_length / n;
  double integral = 0.0;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) * dr;
    integral += this->W(r) * 2 * std::numbers::pi * r * dr;
  }
  EXPECT_NEAR(integral, 1.0, 1e-8);
}

TYPED_TEST(KernelTest, FIsTheDerivativeOverR) {
  for (const double r : {0.05, 0.2, 0.36, 0.38, 0.5, 0.7}) {
    const double d = 1e-6;
    const double derivative = (this->W(r + d) - this->W(r - d)) / (2 * d);
    EXPECT_NEAR(this->F(r), derivative / r, 1e-4 * std::abs(derivative / r)) << r;
  }
}

TYPED_TEST(KernelTest, VanishesOutsideTheSupport) {
  EXPECT_EQ(this->W(1.0001 * 2 * smoothing_length), 0.0);
  EXPECT_EQ(this->F(1.0001 * 2 * smoothing_length), 0.0);
  EXPECT_GT(this->W(0.99 * 2 * smoothing_length), 0.0);
  EXPECT_LT(this->F(0.99 * 2 * smoothing_length), 0.0);
}

TYPED_TEST(KernelTest, IsFiniteAtTheOrigin) {
  EXPECT_TRUE(std::isfinite(this->F(0.0)));
  EXPECT_GT(this->W(0.0), this->W(1e-2));
}

TEST(CubicSpline, ValuesOfMonaghanAndLattanzio) {
  const CubicSpline<double> kernel(1.0);
  EXPECT_DOUBLE_EQ(sigma_h2<CubicSpline<double>>(1.0), 15 / (7 * std::numbers::pi));
  EXPECT_DOUBLE_EQ(kernel.W(0.0), 2.0 / 3);
  EXPECT_DOUBLE_EQ(kernel.W(1.0), 1.0 / 6);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include <cmath>

#include "material/elastoviscoplastic.hpp"

namespace talus {
namespace {

TEST(Elastoviscoplastic, SimpleShearLoadsAtTheRateG) {
  const double G = 3e6, rate = 0.02;
  const Dev t = elastic_rate({}, deviator(strain_rate({0, rate, 0, 0})), spin({0, rate, 0, 0}), G);
  EXPECT_DOUBLE_EQ(t.xy, G * rate);
  EXPECT_EQ(t.xx, 0.0);
}

TEST(Elastoviscoplastic, RigidRotationTurnsTheStressAndNothingElse) {
  // v = w x r: L = w (0 -1; 1 0). After the angle a: t(a) = Q t Q^T.
  const double w = 1.3, dt = 1e-5;
  const Dev start{4, 1.5, -2};
  Dev t = start;
  const Mat2 L{0, -w, w, 0};
  for (int n = 0; n < 40000; ++n) {  // midpoint
    const Dev half = t + (0.5 * dt) * elastic_rate(t, deviator(strain_rate(L)), spin(L), 1e6);
    t = t + dt * elastic_rate(half, deviator(strain_rate(L)), spin(L), 1e6);
  }
  const double a = w * dt * 40000, c = std::cos(a), s = std::sin(a);
  EXPECT_NEAR(t.xx, c * c * start.xx + s * s * start.yy - 2 * s * c * start.xy, 1e-7);
  EXPECT_NEAR(t.yy, s * s * start.xx + c * c * start.yy + 2 * s * c * start.xy, 1e-7);
  EXPECT_NEAR(t.xy, s * c * (start.xx - start.yy) + (c * c - s * s) * start.xy, 1e-7);
}

TEST(Elastoviscoplastic, ReturnScalesOntoTheYieldSurfaceOnly) {
  const Dev t{300, -100, 250};
  EXPECT_EQ(return_to_yield(t, 1e9), t);
  const Dev r = return_to_yield(t, 120);
  EXPECT_NEAR(magnitude(r), 120, 1e-10);
  EXPECT_NEAR(r.xx / r.xy, t.xx / t.xy, 1e-12);
  EXPECT_EQ(return_to_yield(t, 0.0), (Dev{0, 0, 0}));
  EXPECT_EQ(return_to_yield({}, 0.0), (Dev{}));
}

TEST(Tensor, MirrorTurnsTheShearOfTheWallPlaneRound) {
  const Sym2 s{7, -3, 2};
  const Vec2 n{0.6, 0.8}, t{-0.8, 0.6};
  const Sym2 m = mirrored(s, n);
  EXPECT_NEAR(dot(t, m * n), -dot(t, s * n), 1e-14);
  EXPECT_NEAR(dot(n, m * n), dot(n, s * n), 1e-14);
  EXPECT_NEAR(dot(t, m * t), dot(t, s * t), 1e-14);
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include <cmath>

#include "material/constitutive_models-inl.hpp"

namespace talus {
namespace {

using namespace HWY_NAMESPACE;

/// The stress that a particle keeps.
struct ElasticStress {
  Deviator<double> t, rate{0, 0, 0};

  Deviator<double> value() const { return t; }
  void add(Deviator<double> change) { t = t + change; }
  void set_rate(Deviator<double> dt) { rate = dt; }
};

/// Stress of soil with tau_y, at rest.
Deviator<double> at_rest(ElasticStress& elastic, double tau_y, ShearRate norm = ShearRate::consistent) {
  const PointState<double> state{
      .e = {0, 0, 0}, .two_spin = 0, .gamma_dot = 0, .tau_y = tau_y, .eta = 50, .two_G = 2e6};
  Rheology rheology;
  rheology.shear_rate = norm;
  return ElastoViscoplastic<double>(rheology).stress(state, elastic);
}

TEST(Elastoviscoplastic, SimpleShearLoadsAtTheRateG) {
  const double G = 3e6, rate = 0.02;
  const Gradient<double> L{0, rate, 0, 0};
  const auto t = elastic_rate(Deviator<double>{0, 0, 0}, deviatoric_strain_rate(L), two_spin(L), 2 * G);
  EXPECT_DOUBLE_EQ(t.xy, G * rate);
  EXPECT_EQ(t.xx, 0.0);
}

TEST(Elastoviscoplastic, RigidRotationTurnsTheStressAndNothingElse) {
  // v = w x r: L = w (0 -1; 1 0). After the angle a: t(a) = Q t Q^T.
  const double w = 1.3, dt = 1e-5;
  const Deviator<double> start{4, 1.5, -2};
  const Gradient<double> L{0, -w, w, 0};
  const auto rate = [&](Deviator<double> t) { return elastic_rate(t, deviatoric_strain_rate(L), two_spin(L), 2e6); };
  Deviator<double> t = start;
  for (int n = 0; n < 40000; ++n) {  // midpoint
    const auto half = t + rate(t) * (0.5 * dt);
    t = t + rate(half) * dt;
  }
  const double a = w * dt * 40000, c = std::cos(a), s = std::sin(a);
  EXPECT_NEAR(t.xx, c * c * start.xx + s * s * start.yy - 2 * s * c * start.xy, 1e-7);
  EXPECT_NEAR(t.yy, s * s * start.xx + c * c * start.yy + 2 * s * c * start.xy, 1e-7);
  EXPECT_NEAR(t.xy, s * c * (start.xx - start.yy) + (c * c - s * s) * start.xy, 1e-7);
}

TEST(Elastoviscoplastic, ReturnScalesOntoTheYieldSurfaceOnly) {
  ElasticStress inside{{300, -100, 250}}, outside = inside, printed = inside, strengthless = inside, zero{{0, 0, 0}};
  EXPECT_EQ(at_rest(inside, 1e9).xy, 250);
  EXPECT_EQ(inside.t.xx, 300);
  const auto t = at_rest(outside, 120);
  EXPECT_NEAR(magnitude(t), 120, 1e-10);
  EXPECT_NEAR(t.xx / t.xy, 300.0 / 250, 1e-12);
  EXPECT_NEAR(magnitude(outside.t), 120, 1e-10) << "what the particle keeps is returned as well";
  EXPECT_NEAR(magnitude(at_rest(printed, 120, ShearRate::paper)), std::numbers::sqrt3 * 120, 1e-10);
  EXPECT_EQ(magnitude(at_rest(strengthless, 0)), 0);
  EXPECT_EQ(magnitude(at_rest(zero, 0)), 0);
}

TEST(Elastoviscoplastic, ViscosityAddsToTheElasticStress) {
  ElasticStress elastic{{10, -4, 3}};
  const PointState<double> state{
      .e = {0.5, -0.2, 0.7}, .two_spin = 0, .gamma_dot = 1, .tau_y = 1e3, .eta = 50, .two_G = 2e6};
  const auto t = ElastoViscoplastic<double>(Rheology{}).stress(state, elastic);
  EXPECT_NEAR(t.xx, 10 + 2 * 50 * 0.5, 1e-12);
  EXPECT_NEAR(t.yy, -4 - 2 * 50 * 0.2, 1e-12);
  EXPECT_NEAR(t.xy, 3 + 2 * 50 * 0.7, 1e-12);
  EXPECT_NEAR(elastic.rate.xy, 2e6 * 0.7, 1e-6);
}

TEST(Tensor, MirrorReversesTheShearOfTheWallPlane) {
  const Symmetric<double> s{7, -3, 2};
  const Vector<double> n{0.6, 0.8}, t{-0.8, 0.6};
  const auto m = mirrored(s, n);
  EXPECT_NEAR(dot(t, m * n), -dot(t, s * n), 1e-14);
  EXPECT_NEAR(dot(n, m * n), dot(n, s * n), 1e-14);
  EXPECT_NEAR(dot(t, m * t), dot(t, s * t), 1e-14);
}

}  // namespace
}  // namespace talus

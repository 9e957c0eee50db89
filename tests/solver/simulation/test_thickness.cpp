#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "simulation/thickness.hpp"

namespace talus {
namespace {

constexpr double spread = 3.0;                           ///< half width of the weight in spacings
constexpr double variance = spread * spread / 7.0;       ///< of the weight, in spacings squared: integral of d^2 w(d)
constexpr double wedge_height = 4.0, wedge_length = 16;  ///< [m]

double wedge_profile(double s) { return s < 0.0 ? 0.0 : std::max(0.0, wedge_height * (1.0 - s / wedge_length)); }
double parabola(double s) { return s < 0.0 ? 0.0 : std::max(0.0, 3.0 * (1.0 - s * s / 144.0)); }

/// Soil of height h(s) on the square cells of a lattice: cells of a column are cut at the surface, which makes their
/// particles lighter, as in the fill of a case.
/// @param phase   shift of the lattice [-], in [0, 1)
/// @param jitter  largest displacement of a particle in spacings
template <class Height>
std::vector<SoilParcel> deposit(const Height& h, double length, double dx, double phase = 0.0, double jitter = 0.0,
                                unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> displacement(-jitter * dx, jitter * dx);
  std::vector<SoilParcel> parcels;
  for (double left = phase * dx; left < length; left += dx) {
    const double area = dx / 6.0 * (h(left) + 4.0 * h(left + 0.5 * dx) + h(left + dx));  // Simpson
    for (double filled = 0.0; filled < area; filled += dx * dx)
      parcels.push_back({left + 0.5 * dx + displacement(random), std::min(dx * dx, area - filled)});
  }
  std::ranges::sort(parcels, {}, &SoilParcel::run_out);
  return parcels;
}

/// A layer of `rows` rows from 0 to `length`.
std::vector<SoilParcel> layer(int rows, double length, double dx) {
  return deposit([&](double) { return rows * dx; }, length - 0.5 * dx, dx);
}

TEST(Thickness, IsThatOfALayerAndHoldsAllSoil) {
  const double dx = 0.25;
  const std::vector<SoilParcel> parcels = layer(3, 20.0, dx);
  for (const double s : {5.0, 5.1, 7.77}) EXPECT_NEAR(thickness(parcels, dx, s), 3 * dx, 3e-3 * dx);
  EXPECT_NEAR(thickness(parcels, dx, 20.0), 1.5 * dx, 3e-3 * dx) << "half of the weight lies beyond the end";
  EXPECT_EQ(thickness(parcels, dx, 20.0 + spread * dx), 0.0);
  double area = 0.0, integral = 0.0;
  for (const SoilParcel& parcel : parcels) area += parcel.area;
  for (double s = -2.0; s < 22.0; s += 0.01) integral += 0.01 * thickness(parcels, dx, s);
  EXPECT_NEAR(integral, area, 1e-6 * area);
}

TEST(FrontAtThickness, OfAWedge) {  // 4 (1 - s/16) = 0.5 at s = 14
  for (const double dx : {0.2, 0.1})
    for (const double phase : {0.0, 0.3, 0.5})
      EXPECT_NEAR(*front_at_thickness(deposit(wedge_profile, wedge_length, dx, phase), dx, 0.5), 14.0, 0.02 * dx);
}

TEST(FrontAtThickness, OfAParabola) {
  // The weight has the variance v, so T(s) = 3 (1 - (s^2 + v)/144) away from the tip: T = 1 at s^2 = 96 - v.
  for (const double dx : {0.4, 0.2})
    EXPECT_NEAR(*front_at_thickness(deposit(parabola, 12.0, dx), dx, 1.0), std::sqrt(96.0 - variance * dx * dx),
                0.02 * dx);
}

TEST(FrontAtThickness, HardlyMovesWhenTheSpacingIsHalved) {
  for (const double t : {0.3, 0.6, 1.0}) {
    const double coarse = *front_at_thickness(deposit(wedge_profile, wedge_length, 0.2), 0.2, t);
    EXPECT_NEAR(*front_at_thickness(deposit(wedge_profile, wedge_length, 0.1), 0.1, t), coarse, 0.1 * 0.1) << t;
    const double coarse_parabola = *front_at_thickness(deposit(parabola, 12.0, 0.2), 0.2, t);
    EXPECT_NEAR(*front_at_thickness(deposit(parabola, 12.0, 0.1), 0.1, t), coarse_parabola, 0.1 * 0.1) << t;
  }
}

TEST(FrontAtThickness, HardlyMovesWithTheParticles) {
  // Independent displacements of variance e^2 change T by the standard deviation sqrt(T A e^2 integral w'^2 ds), where
  // A = dx^2 and the integral is 15/(7 R^3), and the front by that over the slope of the wedge_profile.
  const double dx = 0.2, t = 0.5, jitter = 0.1, radius = spread * dx;
  const double expected = std::sqrt(t * dx * dx * std::pow(jitter * dx, 2) / 3.0 * 15.0 / (7.0 * std::pow(radius, 3))) /
                          (wedge_height / wedge_length);
  const double still = *front_at_thickness(deposit(wedge_profile, wedge_length, dx), dx, t);
  double sum = 0.0, most = 0.0;
  constexpr unsigned draws = 200;
  for (unsigned seed = 0; seed < draws; ++seed) {
    const double moved =
        *front_at_thickness(deposit(wedge_profile, wedge_length, dx, 0.0, jitter, seed), dx, t) - still;
    sum += moved * moved;
    most = std::max(most, std::abs(moved));
  }
  // The standard deviation of 200 draws is known to 5 %: within four times that.
  EXPECT_NEAR(std::sqrt(sum / draws), expected, 4.0 / std::sqrt(2.0 * draws) * expected);
  EXPECT_LT(most, 0.35 * dx);
}

TEST(FrontAtThickness, MovesContinuously) {  // whatever of the lattice the front falls on
  const double dx = 0.2;
  double before = *front_at_thickness(deposit(wedge_profile, wedge_length, dx), dx, 0.5);
  for (int k = 1; k <= 40; ++k) {  // 0.01 m of height at the tip a step: 0.04 m of front, a fifth of a spacing
    const double more = 0.01 * k;
    const auto raised = [&](double s) { return wedge_profile(s) + (s < 0.0 ? 0.0 : more); };
    const double now = *front_at_thickness(deposit(raised, wedge_length, dx), dx, 0.5);
    EXPECT_NEAR(now - before, 0.01 * wedge_length / wedge_height, 0.05 * dx) << k;
    before = now;
  }
}

TEST(FrontAtThickness, DoesNotSeeASingleRowInFront) {
  const double dx = 0.2, t = 1.5 * dx;
  const std::vector<SoilParcel> body = layer(4, 10.0, dx);
  const double alone = *front_at_thickness(body, dx, t);
  const auto with_tail = [&](int particles) {
    std::vector<SoilParcel> parcels = body;
    for (int k = 0; k < particles; ++k) parcels.push_back({10.0 + (k + 0.5) * dx, dx * dx});
    return *front_at_thickness(parcels, dx, t);
  };
  EXPECT_LT(with_tail(5) - alone, 1.5 * dx);
  for (const int particles : {6, 10, 60}) EXPECT_NEAR(with_tail(particles), with_tail(5), 1e-9);
  EXPECT_FALSE(front_at_thickness(layer(1, 10.0, dx), dx, t));
  EXPECT_NEAR(front_at_thickness(layer(2, 10.0, dx), dx, t).value_or(0.0), 10.0, 1.0 * dx);
}

TEST(FrontAtThickness, IsNoneWhereNothingIsSoThick) {
  EXPECT_FALSE(front_at_thickness({}, 0.1, 0.1));
  EXPECT_FALSE(front_at_thickness(layer(3, 10.0, 0.2), 0.2, 0.7));
  EXPECT_TRUE(front_at_thickness(layer(3, 10.0, 0.2), 0.2, 0.5));
}

}  // namespace
}  // namespace talus

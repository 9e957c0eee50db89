// A random field with data, trend and averaging, as the particles get it.
#include <gtest/gtest.h>

#include <cmath>

#include "case/load.hpp"
#include "math/angle.hpp"
#include "particle_nearest.hpp"
#include "run/realization.hpp"

namespace talus {
namespace {

using test::particle_nearest;

Case slope_with(const Json& field) {
  Json document = {{"title", "slope"},
                   {"particle_spacing_m", 0.5},
                   {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
                   {"slide", {{"outlines", {{{"outline_m", {{0, 4}, {8, 0}, {10, 0}, {4, 7}, {0, 7}}}}}}}},
                   {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}}},
                   {"time", {{"end_s", 3}}},
                   {"random_field", {{"correlation_length_m", 2}, {"cov_tan_phi", 0.2}}}};
  document["random_field"].update(field);
  return load_case(document, "").value;
}

std::vector<double> angles_deg(const Case& c, std::int64_t realization, const ParticlePlan& plan) {
  std::vector<double> out;
  for (const double t :
       strength(c.model, c.field, c.study, plan, {.seed = 5, .realization = realization}).properties.tan_phi)
    out.push_back(friction_angle_deg(t));
  return out;
}

// Exact data at the places of particles are met to rounding, by every sampler, marginal and sign of sigma.
TEST(FieldOfACase, RealizationsMeetExactData) {
  const Case plain = slope_with(Json::object());
  const ParticlePlan plan = plan_particles(plain.model);
  const std::size_t one = particle_nearest(plain, {2, 5}), other = particle_nearest(plain, {6, 3});
  const Vec2 a = plan.soil[one].x, b = plan.soil[other].x;
  const Json data = {{a.x, a.y, 31.5, 0.0}, {b.x, b.y, 19.0, 0.0}};
  for (const Json& field :
       {Json{{"data", data}}, Json{{"data", data}, {"sampler", "circulant_embedding"}, {"covariance", "matern_3_2"}},
        Json{{"data", data}, {"mean_tan_phi", 0.4}, {"terms", 30}},
        Json{{"data", data}, {"trend_deg_per_m", 1.0}, {"covariance", "squared_exponential"}, {"dip_deg", 20}}})
    for (const std::int64_t realization : {0, 1}) {
      const std::vector<double> phi = angles_deg(slope_with(field), realization, plan);
      EXPECT_NEAR(phi[one], 31.5, 1e-6) << field.dump();
      EXPECT_NEAR(phi[other], 19.0, 1e-6) << field.dump();
    }
}

// 2,000 realizations scatter about an uncertain datum as kriging says: its own error e (2 deg) and the prior's stdev s
// make the mean and the variance 1/(1/s^2 + 1/e^2) on the scale of ln tan(phi). z = 5 standard errors.
TEST(FieldOfACase, RealizationsScatterAboutAnUncertainDatum) {
  const Case plain = slope_with(Json::object());
  const std::size_t at = particle_nearest(plain, {4, 4});
  const ParticlePlan plan = plan_particles(plain.model);
  const Vec2 x = plan.soil[at].x;
  const Case c =
      slope_with({{"data", {{x.x, x.y, 30.0, 2.0}}}, {"sampler", "circulant_embedding"}, {"grid_spacing_m", 0.5}});
  constexpr int n = 2000;
  double sum = 0, squares = 0;
  for (int k = 0; k < n; ++k) {
    const double value = std::log(std::tan(radians(angles_deg(c, k, plan)[at])));
    sum += value;
    squares += value * value;
  }
  const double s2 = std::log1p(0.2 * 0.2), e = radians(2.0) * 2 / std::sin(radians(60.0)), e2 = e * e;
  const double prior = std::log(std::tan(radians(25.0))), datum = std::log(std::tan(radians(30.0)));
  const double mean = (prior / s2 + datum / e2) / (1 / s2 + 1 / e2), variance = 1 / (1 / s2 + 1 / e2);
  EXPECT_NEAR(sum / n, mean, 5 * std::sqrt(variance / n));
  EXPECT_NEAR(squares / n - sum / n * sum / n, variance, 5 * variance * std::sqrt(2.0 / n));
}

TEST(FieldOfACase, TheTrendRaisesTheMedianWithDepth) {
  const Case c = slope_with({{"trend_deg_per_m", 1.5}});
  const ParticlePlan plan = plan_particles(c.model);
  const auto median = strength(c.model, c.field, c.study, plan, {}).properties.tan_phi;
  for (std::size_t i = 0; i < plan.soil.size(); ++i) {
    const Vec2 p = plan.soil[i].x;
    const double surface = p.x < 4 ? 7.0 : 7.0 - (p.x - 4) * 7.0 / 6.0;
    EXPECT_NEAR(friction_angle_deg(median[i]), 25 + 1.5 * (surface - p.y), 1e-9) << p.x << ' ' << p.y;
  }
}

// Averaging over cells narrows the distribution of tan(phi) and keeps its mean: 1,000 realizations, z = 5.
TEST(FieldOfACase, AveragingKeepsTheMean) {
  const Case c = slope_with({{"correlation_length_m", 0.5},
                             {"cov_tan_phi", 0.5},
                             {"sampler", "circulant_embedding"},
                             {"grid_spacing_m", 0.25}});
  ASSERT_TRUE(c.field->cell_average);
  const ParticlePlan plan = plan_particles(c.model);
  constexpr int n = 1000;
  double sum = 0, squares = 0;
  for (int k = 0; k < n; ++k) {
    double mean = 0;
    const Strength drawn = strength(c.model, c.field, c.study, plan, {.seed = 5, .realization = k});
    for (const double t : drawn.properties.tan_phi) mean += t / static_cast<double>(drawn.properties.tan_phi.size());
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
  EXPECT_NEAR(mean, std::tan(radians(25.0)) * std::sqrt(1 + 0.25), 5 * error);  // exp(mu + sigma^2/2)
  EXPECT_LT(5 * error, 0.015);  // the median kept instead would be 0.026 lower
}

TEST(FieldOfACase, SpreadIsThatOfTheRealizations) {
  const Case c =
      slope_with({{"data", {{4.0, 4.0, 30.0, 0.5}}}, {"covariance", "matern_3_2"}, {"sampler", "circulant_embedding"}});
  const ParticlePlan plan = plan_particles(c.model);
  const FieldSpread spread = field_spread(c.model, *c.field, plan, Property::friction);
  const std::size_t near = particle_nearest(c, {4, 4}), far = particle_nearest(c, {9.5, 0.3});
  EXPECT_NEAR(friction_angle_deg(spread.median[near]), 30, 1.0);
  EXPECT_NEAR(friction_angle_deg(spread.median[far]), 25, 1.0);
  EXPECT_LT(spread.stdev[near], 0.4 * spread.stdev[far]);
  constexpr int n = 500;
  double sum = 0, squares = 0;
  for (int k = 0; k < n; ++k) {
    const double phi = radians(angles_deg(c, k, plan)[far]);
    sum += phi;
    squares += phi * phi;
  }
  // first order in sigma = 0.2; sampling error of a stdev of 500: 3 %
  EXPECT_NEAR(spread.stdev[far], std::sqrt(squares / n - sum / n * sum / n), 0.15 * spread.stdev[far]);
}

}  // namespace
}  // namespace talus

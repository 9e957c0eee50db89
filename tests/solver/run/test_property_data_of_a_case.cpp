// Random properties with data and a trend, as the particles get them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "case/load.hpp"
#include "math/angle.hpp"
#include "particle_nearest.hpp"
#include "run/property_draw.hpp"
#include "run/realization.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

using test::particle_nearest;

/// A slope with random friction and cohesion; `field` and `properties` are merged into the case.
Case slope_with_data(const Json& field, const Json& properties = Json::object()) {
  Json document = {
      {"title", "slope"},
      {"particle_spacing_m", 0.5},
      {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
      {"slide", {{"outlines", {{{"outline_m", {{0, 4}, {8, 0}, {10, 0}, {4, 7}, {0, 7}}}}}}}},
      {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}, {"cohesion_kPa", 5}, {"viscosity_Pa_s", 500}}},
      {"time", {{"end_s", 3}}},
      {"random_field",
       {{"correlation_length_m", 2},
        {"properties", {{"friction", {{"cov", 0.15}}}, {"cohesion", {{"cov", 0.3}}}}},
        {"correlation", {{{"between", {"friction", "cohesion"}}, {"value", -0.5}}}}}}};
  document["random_field"].update(field);
  document["random_field"]["properties"].merge_patch(properties);
  return load_case(document, "").value;
}

Strength conditioned_soil(const Case& c, std::optional<std::int64_t> realization) {
  return strength(c.model, c.field, c.study, plan_particles(c.model), {.seed = 5, .realization = realization});
}

// Exact data on friction (in either place) and on cohesion, some at one point, are met by every realization.
TEST(PropertyDataOfACase, RealizationsMeetExactData) {
  const Case plain = slope_with_data(Json::object());
  const ParticlePlan plan = plan_particles(plain.model);
  const std::size_t one = particle_nearest(plain, {2, 5}), other = particle_nearest(plain, {6, 3});
  const Vec2 a = plan.soil[one].x, b = plan.soil[other].x;
  const Json angles = {{a.x, a.y, 29.0, 0.0}};
  const Json kilopascals = {{a.x, a.y, 8.0, 0.0}, {b.x, b.y, 3.0, 0.0}};
  const Json cohesion = {{"cohesion", {{"data", kilopascals}}}};
  Json both = cohesion;
  both["friction"]["data"] = angles;
  for (const Json& field :
       {Json{{"data", angles}}, Json{{"data", angles}, {"terms", 30}},
        Json{{"data", angles}, {"trend_deg_per_m", 1.0}, {"covariance", "matern_5_2"}, {"dip_deg", 20}},
        Json{{"data", angles}, {"sampler", "circulant_embedding"}, {"covariance", "squared_exponential"}}, Json()})
    for (const std::int64_t realization : {0, 1}) {
      const Case c = field.is_null() ? slope_with_data(Json::object(), both) : slope_with_data(field, cohesion);
      const SoilProperties soil = conditioned_soil(c, realization).properties;
      EXPECT_NEAR(friction_angle_deg(soil.tan_phi[one]), 29.0, 1e-6) << field.dump();
      EXPECT_NEAR(soil.c[one], 8e3, 1e-3) << field.dump();
      EXPECT_NEAR(soil.c[other], 3e3, 1e-3) << field.dump();
    }
}

// The trend raises the median of every distribution by so many degrees for every metre; cohesion has none.
TEST(PropertyDataOfACase, TheTrendRaisesTheMedianOfFriction) {
  for (const char* marginal : {"lognormal", "normal"}) {
    const Case c = slope_with_data({{"trend_deg_per_m", 1.5}}, {{"friction", {{"marginal", marginal}}}});
    const Case level = slope_with_data(Json::object(), {{"friction", {{"marginal", marginal}}}});
    const ParticlePlan plan = plan_particles(c.model);
    const Strength raised = conditioned_soil(c, std::nullopt), flat = conditioned_soil(level, std::nullopt);
    for (std::size_t i = 0; i < plan.soil.size(); ++i) {
      const double depth = depth_below_surface(c.model.slide, plan.soil[i].x);
      EXPECT_NEAR(friction_angle_deg(raised.properties.tan_phi[i]),
                  friction_angle_deg(flat.properties.tan_phi[i]) + 1.5 * depth, 1e-9);
    }
    EXPECT_EQ(raised.properties.c, flat.properties.c);
    EXPECT_GT(raised.summary.properties[0].mean, flat.summary.properties[0].mean);
    EXPECT_EQ(raised.summary.properties[1].mean, flat.summary.properties[1].mean);
    // A uniform scale of tan(phi) leaves the coefficient of variation at each point; the mixture over depths has more.
    EXPECT_GT(raised.summary.properties[0].cov, flat.summary.properties[0].cov);
  }
}

// The spread of friction and of cohesion is that of 1,500 realizations, near the data and away: median within 5
// standard errors of a median (1.25 s/sqrt(n)) and 1 % of the first-order formula, standard deviation within 12 %, of
// which 5/sqrt(2 n) = 9 % is sampling error.
TEST(PropertyDataOfACase, SpreadIsThatOfTheRealizations) {
  const Case c = slope_with_data({{"data", {{4.0, 4.0, 29.0, 0.5}}}, {"covariance", "matern_3_2"}, {"terms", 40}},
                                 {{"cohesion", {{"cov", 0.2}, {"data", {{4.0, 4.0, 7.0, 0.3}}}}}});
  const ParticlePlan plan = plan_particles(c.model);
  const std::size_t places[] = {particle_nearest(c, {4, 4}), particle_nearest(c, {9.5, 0.3})};
  const PropertyFields fields = property_fields(c.model, *c.field);  // set up once: 40 modes take a while
  const SoilProperties materials = conditioned_soil(c, std::nullopt).properties;
  constexpr std::size_t n = 1500;
  std::vector<double> drawn[2][2];
  for (std::size_t k = 0; k < n; ++k) {
    SoilProperties soil = materials;
    Model model = c.model;
    draw_properties(fields, plan, fields.draw(5, k), soil, model);
    for (std::size_t p = 0; p < 2; ++p) {
      drawn[0][p].push_back(std::atan(soil.tan_phi[places[p]]));
      drawn[1][p].push_back(soil.c[places[p]]);
    }
  }
  for (const Property property : {Property::friction, Property::cohesion}) {
    const FieldSpread spread = field_spread(c.model, *c.field, plan, property);
    for (std::size_t p = 0; p < 2; ++p) {
      std::vector<double>& x = drawn[index_of(property)][p];
      std::ranges::sort(x);
      double mean = 0, squares = 0;
      for (const double value : x) mean += value / n;
      for (const double value : x) squares += (value - mean) * (value - mean) / n;
      const double stdev = std::sqrt(squares);
      const double median =
          property == Property::friction ? std::atan(spread.median[places[p]]) : spread.median[places[p]];
      EXPECT_NEAR(x[n / 2], median, 5 * 1.25 * stdev / std::sqrt(n) + 0.01 * stdev);
      EXPECT_NEAR(spread.stdev[places[p]] / stdev, 1.0, 0.12);
    }
    EXPECT_LT(spread.stdev[places[0]], 0.7 * spread.stdev[places[1]]);
  }
  const FieldSpread fixed = field_spread(c.model, *c.field, plan, Property::viscosity);
  EXPECT_EQ(fixed.median[0], 500);
  EXPECT_EQ(fixed.stdev[0], 0);
}

// Coefficients of the data follow those of the properties; the summary counts them.
TEST(PropertyDataOfACase, CoefficientsOfTheData) {
  const Case c =
      slope_with_data({{"data", {{4.0, 4.0, 29.0, 0.5}}}, {"terms", 7}}, {{"cohesion", {{"data", {{4, 4, 7, 1}}}}}});
  const Strength soil = conditioned_soil(c, 2);
  EXPECT_EQ(soil.summary.terms, 16);
  ASSERT_EQ(soil.xi.size(), 16u);
  Case given = c;
  given.field->xi = soil.xi;
  EXPECT_EQ(conditioned_soil(given, std::nullopt).properties.c, soil.properties.c);
  EXPECT_NE(soil.xi[14], 0.0);
  given.field->xi.pop_back();
  EXPECT_THROW(conditioned_soil(given, std::nullopt), ConfigError);
}

}  // namespace
}  // namespace talus

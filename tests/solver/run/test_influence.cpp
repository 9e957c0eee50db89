// What a study knows of its draws: the numbers are those that the runs use, and where the soil matters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "particles/geometry.hpp"
#include "run/drawn_numbers.hpp"
#include "run/friction_field.hpp"
#include "run/influence.hpp"
#include "run/realization.hpp"
#include "statistics/stream.hpp"

namespace talus {
namespace {

constexpr std::uint64_t seed = 3;

Case layered_slope(const Json& field) {
  Json document = {{"title", "slope"},
                   {"particle_spacing_m", 0.5},
                   {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
                   {"slide", {{"outlines", {{{"outline_m", {{0, 4}, {8, 0}, {10, 0}, {4, 7}, {0, 7}}}}}}}},
                   {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}}},
                   {"time", {{"end_s", 3}}},
                   {"random_field", {{"correlation_length_m", 3}, {"terms", 6}, {"cell_average", false}}}};
  document["random_field"].update(field);
  return load_case(document, "").value;
}

/// The coefficients of a realization as a study computes them from its plan.
std::vector<double> recomputed(const std::vector<DrawnNumbers>& draws, std::uint64_t realization) {
  std::vector<double> xi;
  for (const DrawnNumbers& of : draws)
    for (std::int64_t k = 0; k < of.count; ++k)
      xi.push_back(standard_normal(seed, realization, static_cast<std::uint32_t>(k), of.key));
  return xi;
}

TEST(DrawnNumbers, AreThoseThatARunUses) {
  for (const Json& field :
       {Json{{"log_stdev", 0.2}}, Json{{"properties",
                                        {{"friction", {{"cov", 0.2}}},
                                         {"cohesion", {{"mean_kPa", 2}, {"cov", 0.4}, {"layers", "independent"}}},
                                         {"viscosity", {{"mean_Pa_s", 500}, {"cov", 0.3}, {"varies", "once"}}}}}}}) {
    const Case c = layered_slope(field);
    const std::vector<DrawnNumbers> draws = drawn_numbers(c);
    const Strength soil =
        strength(c.model, c.field, c.study, plan_particles(c.model), {.seed = seed, .realization = 7});
    EXPECT_EQ(recomputed(draws, 7), soil.xi);
    EXPECT_NE(recomputed(draws, 8), soil.xi);
  }
}

TEST(DrawnNumbers, LeaveOutTheNuggetAndNameWhatHasNoOrder) {
  EXPECT_EQ(drawn_numbers(layered_slope({{"log_stdev", 0.2}, {"nugget", 0.1}})).at(0).count, 6);
  const auto embedded = drawn_numbers(layered_slope({{"log_stdev", 0.2}, {"sampler", "circulant_embedding"}}));
  EXPECT_EQ(embedded.at(0).name, "friction");
  EXPECT_EQ(embedded.at(0).count, 0);
  EXPECT_TRUE(drawn_numbers(layered_slope({{"log_stdev", 0.0}})).empty());
}

// Where the quantity is Z(x0) itself, its influence at x is Cov(Z(x0), Z(x)) / stdev(Z(x)): the standard deviation at
// x0, and less elsewhere. A linear quantity leaves no residual, so the intervals have no width.
TEST(Influence, OfTheFieldAtAPointIsItsCovariance) {
  const Case c = layered_slope({{"log_stdev", 0.2}});
  const std::vector<Vec2> points{{2.0, 5.0}, {4.0, 3.5}, {7.0, 1.0}};
  const RandomField field = make_field(c.model, *c.field);
  Plan plan{.seed = seed, .draws = drawn_numbers(c)};
  std::vector<std::int64_t> realizations;
  std::vector<double> values;
  for (std::int64_t i = 0; i < 50; ++i) {
    realizations.push_back(i);
    values.push_back(30 + field.gaussian(points, field.draw(seed, static_cast<std::uint64_t>(i)))[0]);
  }
  const std::vector<Influence> found = influence_at(c, points, plan, regress(plan, realizations, values, false));
  ASSERT_EQ(found.size(), 1U);
  const std::vector<double> variance = field.variance(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double covariance = 0.0;
    for (std::size_t k = 0; k < field.terms(); ++k) {
      std::vector<double> one(field.terms(), 0.0);
      one[k] = 1.0;
      const std::vector<double> a = field.gaussian(points, one);
      covariance += a[0] * a[i];
    }
    EXPECT_NEAR(found[0].value[i], covariance / std::sqrt(variance[i]), 1e-9);
    EXPECT_NEAR(found[0].half_width[i], 0.0, 1e-9);
  }
  EXPECT_NEAR(found[0].value[0], std::sqrt(variance[0]), 1e-9);
}

}  // namespace
}  // namespace talus

// Kriging of residuals: against GSTools (data/kriging.csv), and as properties of what is drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "linear_sampler.hpp"
#include "random_field/random_field.hpp"
#include "reference_table.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

constexpr Box slide{{0.0, 2.0}, {6.0, 5.0}};
const std::vector<GaussianDatum> data{{{0.5, 2.5}, 1.2, 0.0},
                                      {{2.0, 3.0}, -0.7, 0.3},
                                      {{2.2, 3.1}, -0.2, 0.3},
                                      {{4.5, 4.0}, 0.4, 0.1},
                                      {{5.5, 2.2}, -1.5, 0.2}};

FieldSpec circulant(Covariance family) {
  return {.ell_x = 1.5, .ell_y = 0.6, .sampler = FieldSampler::circulant_embedding, .covariance = family};
}

RandomField conditioned(const FieldSpec& spec, double dx = 0.1) {
  RandomField field(spec, slide, dx);
  field.condition(data);
  return field;
}

TEST(Conditioning, MeanAndVarianceAreThoseOfGsTools) {
  std::size_t rows = 0;
  for (const auto& row : test::reference_table("kriging.csv")) {
    FieldSpec spec = circulant(test::family_named(row.at("family")));
    spec.ell_x = std::stod(row.at("ell_x"));
    spec.ell_y = std::stod(row.at("ell_y"));
    spec.dip = std::stod(row.at("dip_deg")) * std::numbers::pi / 180;
    spec.nugget = std::stod(row.at("nugget"));
    const RandomField field = conditioned(spec);
    const std::vector<Vec2> point{{std::stod(row.at("x")), std::stod(row.at("y"))}};
    const std::vector<double> zero(field.terms(), 0.0);
    EXPECT_NEAR(field.gaussian(point, zero)[0], std::stod(row.at("mean")), 1e-9) << row.at("family");
    EXPECT_NEAR(field.conditional_variance(point)[0], std::stod(row.at("variance")) + spec.nugget, 1e-9);
    ++rows;
  }
  EXPECT_EQ(rows, 56u);
}

// Whatever the sampler draws, and however few its modes: an exact datum is met, the others up to their drawn errors.
TEST(Conditioning, RealizationsMeetTheData) {
  for (const FieldSampler sampler : {FieldSampler::karhunen_loeve, FieldSampler::circulant_embedding})
    for (const Covariance family : {Covariance::exponential, Covariance::matern_3_2}) {
      FieldSpec spec = circulant(family);
      spec.sampler = sampler;
      const RandomField field = conditioned(spec);
      ASSERT_EQ(field.terms(), field.modes() + 5);
      std::vector<Vec2> places;
      for (const GaussianDatum& datum : data) places.push_back(datum.x);
      std::vector<double> xi = field.draw(1, 3);
      for (std::size_t i = 0; i < 5; ++i) xi[field.modes() + i] = 0;
      const double first = field.gaussian(places, xi)[0];
      EXPECT_NEAR(first, 1.2, 1e-9);
      xi[field.modes()] = 2;  // the error of an exact datum is nothing
      EXPECT_NEAR(field.gaussian(places, xi)[0], 1.2, 1e-9);
    }
}

// The variance stated is that of what is drawn: of the truncated field, and of the mean over cells.
TEST(Conditioning, VarianceIsThatOfTheResponses) {
  const std::vector<Vec2> points{{0.5, 2.5}, {0.9, 2.6}, {2.1, 3.05}, {3.3, 3.4}, {5.9, 4.9}};
  for (const Covariance family : {Covariance::exponential, Covariance::squared_exponential})
    for (double cell : {0.0, 0.4}) {
      FieldSpec spec = circulant(family);
      spec.sampler = FieldSampler::karhunen_loeve;
      spec.terms = 40;
      spec.cell_average = cell > 0;
      const RandomField field = conditioned(spec, cell);
      const std::vector<double> mean = field.gaussian(points, std::vector<double>(field.terms(), 0.0));
      std::vector<double> variance(points.size());
      for (std::size_t k = 0; k < field.terms(); ++k) {
        std::vector<double> xi(field.terms(), 0.0);
        xi[k] = 1;
        const auto z = field.gaussian(points, xi);
        for (std::size_t i = 0; i < points.size(); ++i) variance[i] += (z[i] - mean[i]) * (z[i] - mean[i]);
      }
      const auto stated = field.conditional_variance(points);
      for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(stated[i], variance[i], 1e-9) << cell << ' ' << i;
    }
}

TEST(Conditioning, FarFromTheDataTheFieldIsAsWithout) {
  FieldSpec spec = circulant(Covariance::exponential);
  spec.ell_x = spec.ell_y = 0.1;
  const RandomField with = conditioned(spec), without(spec, slide, 0.1);
  std::vector<double> xi = with.draw(1, 2);
  const std::vector<Vec2> far{{3.5, 2.1}, {1.0, 4.9}};
  const auto a = with.gaussian(far, xi);
  xi.resize(without.terms());
  const auto b = without.gaussian(far, xi);
  for (std::size_t i = 0; i < far.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-3);
  EXPECT_NEAR(with.conditional_variance(far)[0], 1, 1e-6);
  EXPECT_EQ(with.variance(), without.variance());
  EXPECT_EQ(with.variance(far), without.variance(far));
}

TEST(Conditioning, DataAtOnePointAreMergedByPrecision) {
  const std::vector<GaussianDatum> two{{{1, 3}, 1.0, 0.2}, {{1, 3}, 2.0, 0.4}, {{2, 3}, 0.5, 0.1}};
  const auto one = merged(two);
  ASSERT_EQ(one.size(), 2u);
  EXPECT_DOUBLE_EQ(one[0].z, (1.0 / 0.04 + 2.0 / 0.16) / (1 / 0.04 + 1 / 0.16));
  EXPECT_DOUBLE_EQ(one[0].error, 1 / std::sqrt(1 / 0.04 + 1 / 0.16));
  const auto exact = merged(std::vector<GaussianDatum>{{{1, 3}, 1.0, 0.2}, {{1, 3}, 2.0, 0.0}, {{1, 3}, 5.0, 0.1}});
  EXPECT_EQ(exact[0].z, 2.0);
  EXPECT_EQ(exact[0].error, 0.0);
}

TEST(Conditioning, RefusesExactDataThatNoFieldMeets) {
  RandomField field(circulant(Covariance::squared_exponential), slide, 0.1);
  const std::vector<GaussianDatum> close{{{1, 3}, 1.0, 0.0}, {{1 + 1e-5, 3}, 2.0, 0.0}};
  try {
    field.condition(close);
    ADD_FAILURE() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.faults.at(0).pointer, "/random_field/data");
  }
  EXPECT_NO_THROW(field.condition(std::vector<GaussianDatum>{{{1, 3}, 1.0, 0.1}, {{1 + 1e-5, 3}, 1.1, 0.1}}));
}

}  // namespace
}  // namespace talus

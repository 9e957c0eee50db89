// Drawn fields of every covariance, with nugget, dip and data: 20,000 draws each, within 5 standard errors.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "covariance_sample.hpp"
#include "random_field/bedding.hpp"

namespace talus {
namespace {

constexpr Box slide{{0.0, 2.0}, {6.0, 5.0}};
constexpr double spacing = 0.25;
const std::vector<Vec2> nodes{{0, 2}, {0.5, 2}, {0.5, 2.5}, {1, 3}, {3, 3.5}, {3, 4}, {5.5, 4.5}, {6, 5}};

FieldSpec circulant(Covariance family) {
  return {.ell_x = 1.5,
          .ell_y = 0.5,
          .sampler = FieldSampler::circulant_embedding,
          .grid_spacing = spacing,
          .covariance = family};
}

TEST(FieldFamilies, CovarianceOfCirculantEmbedding) {
  for (const Covariance family : {Covariance::exponential_isotropic, Covariance::squared_exponential,
                                  Covariance::matern_3_2, Covariance::matern_5_2, Covariance::cosine_exponential}) {
    const FieldSpec spec = circulant(family);
    const Correlation rho(spec);
    test::expect_moments(RandomField(spec, slide, 0.1), nodes, std::vector<double>(nodes.size()),
                         [&](std::size_t i, std::size_t j) { return rho(nodes[i] - nodes[j]); });
  }
}

// 200 modes carry 0.99 of this variance: what is missing is a small part of the sampling error.
TEST(FieldFamilies, CovarianceOfTheGridExpansion) {
  const FieldSpec spec{.ell_x = 3.0, .ell_y = 1.5, .terms = 200, .covariance = Covariance::matern_5_2};
  const RandomField field(spec, slide, 0.1);
  ASSERT_GT(field.captured_variance(), 0.995);
  const Correlation rho(spec);
  test::expect_moments(field, nodes, std::vector<double>(nodes.size()),
                       [&](std::size_t i, std::size_t j) { return rho(nodes[i] - nodes[j]); });
}

// Points that are nodes of the turned grid.
TEST(FieldFamilies, CovarianceAlongADippingBedding) {
  FieldSpec spec = circulant(Covariance::matern_3_2);
  spec.dip = std::numbers::pi / 6;
  const Bedding bedding(spec.dip), back(-spec.dip);
  const Vec2 corner = bedding.around(slide).lo;
  std::vector<Vec2> points;
  for (const Vec2 node : nodes) points.push_back(back.turned(corner + (node - nodes[0])));
  const Correlation rho(spec);
  test::expect_moments(RandomField(spec, slide, 0.1), points, std::vector<double>(points.size()),
                       [&](std::size_t i, std::size_t j) { return rho(bedding.turned(points[i] - points[j])); });
}

TEST(FieldFamilies, NuggetIsWhite) {
  FieldSpec spec = circulant(Covariance::squared_exponential);
  spec.nugget = 0.3;
  const Correlation rho(spec);
  test::expect_moments(
      RandomField(spec, slide, 0.1), nodes, std::vector<double>(nodes.size()),
      [&](std::size_t i, std::size_t j) { return 0.7 * rho(nodes[i] - nodes[j]) + (i == j ? 0.3 : 0); });
}

// Simple kriging: c = C_xy - C_xX (C_XX + S)^-1 C_Xy. Two data, so that the inverse can be written out.
TEST(FieldFamilies, ConditionalMeanAndCovariance) {
  const FieldSpec spec = circulant(Covariance::matern_3_2);
  const Correlation rho(spec);
  const std::vector<GaussianDatum> data{{{0.5, 2.5}, 1.5, 0.0}, {{3.0, 4.0}, -1.0, 0.5}};
  RandomField field(spec, slide, 0.1);
  field.condition(data);
  const double a = 1, d = 1 + 0.25, b = rho(data[0].x - data[1].x), det = a * d - b * b;
  const auto kriged = [&](double u0, double u1, double v0, double v1) {  // u (C_XX + S)^-1 v
    return (d * u0 * v0 - b * (u0 * v1 + u1 * v0) + a * u1 * v1) / det;
  };
  std::vector<double> mean;
  for (const Vec2 p : nodes) mean.push_back(kriged(rho(p - data[0].x), rho(p - data[1].x), data[0].z, data[1].z));
  std::vector<Vec2> points(nodes);
  points.erase(points.begin() + 2);  // the exact datum, which has no spread
  mean.erase(mean.begin() + 2);
  test::expect_moments(field, points, mean, [&](std::size_t i, std::size_t j) {
    const Vec2 p = points[i], q = points[j];
    return rho(p - q) - kriged(rho(p - data[0].x), rho(p - data[1].x), rho(q - data[0].x), rho(q - data[1].x));
  });
}

}  // namespace
}  // namespace talus

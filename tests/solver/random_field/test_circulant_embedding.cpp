#include <gtest/gtest.h>

#include <cmath>

#include "linear_sampler.hpp"
#include "random_field/circulant_embedding.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

constexpr Box oblong{{-1.0, 2.0}, {1.5, 3.5}};

FieldSpec anisotropic(double spacing) {
  return {.ell_x = 1.3, .ell_y = 0.4, .sampler = FieldSampler::circulant_embedding, .grid_spacing = spacing};
}

double exact(const ExponentialCovariance& cx, const ExponentialCovariance& cy, Vec2 p, Vec2 q) {
  return cx(p.x - q.x) * cy(p.y - q.y);
}

TEST(CirculantEmbedding, CovarianceOnNodesIsExact) {
  for (double cell : {0.0, 0.5, 1.1}) {  // finer and coarser than the grid, and points
    FieldSpec spec = anisotropic(0.5);
    spec.cell_average = cell > 0;
    const CirculantEmbedding field(spec, oblong, cell, oblong.lo);
    const std::vector<Vec2> nodes{{-1, 2}, {-0.5, 2}, {1.5, 2}, {0, 2.5}, {-1, 3.5}, {1.5, 3.5}, {0.5, 3.0}};
    const auto responses = test::responses(field, nodes);
    const ExponentialCovariance cx{1.3, cell}, cy{0.4, cell};
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        EXPECT_NEAR(test::covariance(responses, i, j), exact(cx, cy, nodes[i], nodes[j]), 3e-8) << cell << i << j;
    EXPECT_DOUBLE_EQ(field.variance(), cx(0) * cy(0));
  }
}

// Linear interpolation at a fraction t between nodes of correlation r has the variance (1-t)^2 + t^2 + 2 t (1-t) r:
// (1+r)/2 in the middle, (2+r)/3 on average; in two dimensions the product.
TEST(CirculantEmbedding, InterpolationLosesTheStatedVariance) {
  const FieldSpec spec{.ell_x = 1.0, .ell_y = 1.0, .sampler = FieldSampler::circulant_embedding, .grid_spacing = 0.25};
  const CirculantEmbedding field(spec, {{0, 0}, {1, 1}}, 0.1, {0, 0});
  constexpr int side = 20;
  std::vector<Vec2> points{{0.125, 0.125}, {0.25, 0.5}};
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) points.push_back({0.25 + (i + 0.5) / 80, 0.5 + (j + 0.5) / 80});
  const auto responses = test::responses(field, points);
  const double r = std::exp(-0.25);
  EXPECT_NEAR(test::covariance(responses, 0, 0), std::pow((1 + r) / 2, 2), 1e-12);
  EXPECT_NEAR(test::covariance(responses, 1, 1), 1, 1e-12);
  double mean = 0;
  for (std::size_t i = 2; i < points.size(); ++i) mean += test::covariance(responses, i, i) / (side * side);
  EXPECT_NEAR(mean, std::pow((2 + r) / 3, 2), 1e-3);
  EXPECT_NEAR(std::pow((1 + r) / 2, 2), 1 - 0.21, 0.005);  // the figures of the docstring
  EXPECT_NEAR(std::pow((2 + r) / 3, 2), 1 - 0.14, 0.005);
}

// A domain wider than the slide, and not a whole number of spacings, does not move the grid off the particles.
TEST(CirculantEmbedding, ParticlesLieOnNodesByDefault) {
  FieldSpec spec = anisotropic(1);
  spec.grid_spacing.reset();
  spec.ell_y = 1.2;
  const double dx = 0.5;
  const CirculantEmbedding field(spec, {{-1.03, 1.9}, {1.6, 3.7}}, dx, oblong.lo);
  for (double shift : {0.0, 0.5}) {  // Placement::nodes, Placement::cells
    const std::vector<Vec2> particles{{-1 + shift * dx, 2 + shift * dx}, {-1 + (2 + shift) * dx, 2 + (1 + shift) * dx}};
    const auto responses = test::responses(field, particles);
    EXPECT_NEAR(test::covariance(responses, 0, 0), 1, 1e-12);
    EXPECT_NEAR(test::covariance(responses, 1, 1), 1, 1e-12);
    EXPECT_NEAR(test::covariance(responses, 0, 1), std::exp(-1 / 1.3 - 0.5 / 1.2), 1e-12);
  }
}

TEST(CirculantAxis, NodesAndPeriod) {
  const CirculantAxis whole(0.0, 10.0, 0.1, {0.5});
  EXPECT_EQ(whole.nodes(), 101u);
  EXPECT_EQ(whole.period(), 200u);  // the exponential needs no padding
  EXPECT_EQ(CirculantAxis(0.0, 1.0, 0.3, {0.5}).nodes(), 5u);
}

TEST(CirculantAxis, PadsTheAveragedCovariance) {
  const CirculantAxis axis(0.0, 1.0, 0.05, {2.0, 0.2});
  EXPECT_GT(axis.period(), 40u);
}

TEST(CirculantEmbedding, OneDirectionIsConstantAcross) {
  FieldSpec spec = anisotropic(0.25);
  spec.direction = FieldDirection::y;
  const CirculantEmbedding field(spec, oblong, 0.1, oblong.lo);
  const std::vector<Vec2> points{{-1, 2.5}, {1.5, 2.5}, {0, 2}, {0, 3.5}};
  const auto responses = test::responses(field, points);
  EXPECT_NEAR(test::covariance(responses, 0, 1), 1, 1e-12);
  EXPECT_NEAR(test::covariance(responses, 2, 3), std::exp(-1.5 / 0.4), 1e-12);
  EXPECT_LT(field.terms(), 20u);
}

TEST(CirculantEmbedding, OutsideTheDomainTheNearestPointCounts) {
  const CirculantEmbedding field(anisotropic(0.25), oblong, 0.1, oblong.lo);
  std::vector<double> xi(field.terms());
  for (std::size_t k = 0; k < xi.size(); ++k) xi[k] = std::sin(1.7 * static_cast<double>(k * k % 97));
  const std::vector<Vec2> points{{-9, 9}, {-1, 3.5}, {0.3, 0.0}, {0.3, 2.0}};
  const auto z = field.gaussian(points, xi);
  EXPECT_EQ(z[0], z[1]);
  EXPECT_EQ(z[2], z[3]);
}

TEST(CirculantEmbedding, DefaultGridIsHalfOfDxOrAFractionOfThat) {
  const auto terms = [](double ell_y, double dx) {
    FieldSpec spec = anisotropic(1);
    spec.ell_y = ell_y;
    spec.grid_spacing.reset();
    return CirculantEmbedding(spec, {{0, 0}, {10, 10}}, dx, {0, 0}).terms();
  };
  EXPECT_EQ(terms(1.0, 0.5), 80u * 80u);    // dx/2 = ell/4 = 0.25, 40 intervals, twice as many nodes
  EXPECT_EQ(terms(0.9, 0.5), 160u * 160u);  // dx/4
  EXPECT_EQ(terms(1.0, 0.25), 160u * 160u);
}

TEST(CirculantEmbedding, RefusesAGridThatIsTooLarge) {
  for (double spacing : {1e-5, 1e-9, 1e-300}) {
    try {
      CirculantEmbedding(anisotropic(spacing), oblong, 0.1, oblong.lo);
      FAIL() << "no error";
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.faults.at(0).pointer, "/random_field/grid_spacing_m");
    }
  }
}

}  // namespace
}  // namespace talus

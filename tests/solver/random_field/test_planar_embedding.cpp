#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "linear_sampler.hpp"
#include "random_field/planar_embedding.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

constexpr Box oblong{{-1.0, 2.0}, {1.5, 3.5}};
constexpr Covariance families[] = {Covariance::exponential,         Covariance::exponential_isotropic,
                                   Covariance::squared_exponential, Covariance::matern_3_2,
                                   Covariance::matern_5_2,          Covariance::cosine_exponential};

FieldSpec anisotropic(Covariance family, double spacing) {
  return {.ell_x = 0.9,
          .ell_y = 0.4,
          .sampler = FieldSampler::circulant_embedding,
          .grid_spacing = spacing,
          .covariance = family};
}

std::vector<double> some_coefficients(const PlanarEmbedding& field) {
  std::vector<double> xi(field.terms());
  for (std::size_t k = 0; k < xi.size(); ++k) xi[k] = std::sin(1.7 * static_cast<double>(k * k % 97));
  return xi;
}

TEST(PlanarEmbedding, CovarianceOnNodesIsExact) {
  const std::vector<Vec2> nodes{{-1, 2}, {-0.5, 2}, {1.5, 2}, {0, 2.5}, {-1, 3.5}, {1.5, 3.5}, {0.5, 3.0}};
  for (const Covariance family : families) {
    const FieldSpec spec = anisotropic(family, 0.25);
    const PlanarEmbedding field(spec, oblong, 0.1);
    EXPECT_LT(field.error(), 1e-10);
    const auto responses = test::responses(field, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        EXPECT_NEAR(test::covariance(responses, i, j), Correlation(spec)(nodes[i] - nodes[j]), 1e-9)
            << static_cast<int>(family) << ' ' << i << ' ' << j;
  }
}

// Points and cells between nodes, across the edge of the domain and beyond it; cells finer and coarser than the grid.
TEST(PlanarEmbedding, VarianceIsExactEverywhere) {
  const std::vector<Vec2> points{{-1, 2}, {-0.93, 2.11}, {0.125, 2.375}, {1.5, 3.5}, {1.7, 1.4}, {9, 9}};
  for (double cell : {0.0, 0.04, 0.3, 1.1}) {
    FieldSpec spec = anisotropic(Covariance::matern_3_2, 0.25);
    spec.cell_average = cell > 0;
    const PlanarEmbedding field(spec, oblong, cell);
    EXPECT_DOUBLE_EQ(field.variance(), Correlation(spec).cell_variance(cell));
    const auto responses = test::responses(field, points);
    const auto stated = field.variance(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(test::covariance(responses, i, i), field.variance(), 1e-9) << cell << ' ' << i;
      EXPECT_EQ(stated[i], field.variance());
    }
  }
}

TEST(PlanarEmbedding, IsTheSameFieldAtEverySpacing) {
  FieldSpec spec = anisotropic(Covariance::exponential_isotropic, 0.0);
  spec.grid_spacing.reset();
  const PlanarEmbedding coarse(spec, oblong, 0.4), fine(spec, oblong, 0.2);
  ASSERT_EQ(coarse.terms(), fine.terms());
  std::vector<Vec2> points;
  for (int i = 0; i < 50; ++i) points.push_back({-1 + 0.05 * i, 2 + std::fmod(0.37 * i, 1.5)});
  EXPECT_EQ(coarse.gaussian(points, some_coefficients(coarse)), fine.gaussian(points, some_coefficients(fine)));
}

TEST(PlanarEmbedding, QuartersOfACellAverageToTheCell) {
  FieldSpec spec = anisotropic(Covariance::squared_exponential, 0.0);
  spec.grid_spacing.reset();
  spec.cell_average = true;
  const PlanarEmbedding coarse(spec, oblong, 0.4), fine(spec, oblong, 0.2);
  const auto xi = some_coefficients(coarse);
  const Vec2 centre{0.37, 2.71};
  std::vector<Vec2> quarters;
  for (double x : {-0.1, 0.1})
    for (double y : {-0.1, 0.1}) quarters.push_back(centre + Vec2{x, y});
  const auto z = fine.gaussian(quarters, xi);
  EXPECT_NEAR((z[0] + z[1] + z[2] + z[3]) / 4, coarse.gaussian(std::vector{centre}, xi)[0], 0.01);
}

TEST(PlanarEmbedding, OneDirectionIsConstantAcross) {
  for (const FieldDirection direction : {FieldDirection::x, FieldDirection::y}) {
    FieldSpec spec = anisotropic(Covariance::matern_5_2, 0.25);
    spec.direction = direction;
    const PlanarEmbedding field(spec, oblong, 0.1);
    const std::vector<Vec2> points{{-1, 2}, {0, 2}, {-1, 3}};
    const auto responses = test::responses(field, points);
    EXPECT_NEAR(test::covariance(responses, 0, 1), Correlation(spec)({1, 0}), 1e-9);
    EXPECT_NEAR(test::covariance(responses, 0, 2), Correlation(spec)({0, 1}), 1e-9);
    EXPECT_LT(field.terms(), 200u);
  }
}

/// A smooth field on a domain of about one correlation length: the smallest embedding has negative eigenvalues.
FieldSpec smooth(double ell) {
  return {.ell_x = ell,
          .ell_y = ell,
          .sampler = FieldSampler::circulant_embedding,
          .grid_spacing = 0.25,
          .covariance = Covariance::squared_exponential};
}

TEST(PlanarEmbedding, PeriodsGrowUntilTheEmbeddingIsExact) {
  const PlanarEmbedding field(smooth(1.0), oblong, 0.1);
  EXPECT_LT(field.error(), 1e-10);
  EXPECT_GT(field.terms(), 20u * 12u);
}

TEST(PlanarEmbedding, WithoutRoomTheErrorIsStatedAndBoundsEveryCovariance) {
  const FieldSpec spec = smooth(0.7);
  const PlanarEmbedding field(spec, oblong, 0.1, 300);
  EXPECT_GT(field.error(), 1e-6);
  const std::vector<Vec2> nodes{{-1, 2}, {-0.5, 2}, {1.5, 2}, {0, 2.5}, {-1, 3.5}, {1.5, 3.5}, {0.5, 3.0}};
  const auto responses = test::responses(field, nodes);
  double worst = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      worst = std::max(worst, std::abs(test::covariance(responses, i, j) - Correlation(spec)(nodes[i] - nodes[j])));
  EXPECT_LE(worst, field.error());
  EXPECT_GT(worst, field.error() / 100);
  EXPECT_NEAR(test::covariance(responses, 2, 2), 1, 1e-12);
}

TEST(PlanarEmbedding, RefusesALargeError) {
  try {
    PlanarEmbedding(smooth(3.0), oblong, 0.1, 300);
    ADD_FAILURE() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.faults.at(0).pointer, "/random_field/grid_spacing_m");
  }
}

TEST(PlanarEmbedding, RefusesAGridThatIsTooLarge) {
  EXPECT_THROW(PlanarEmbedding(anisotropic(Covariance::matern_3_2, 1e-5), oblong, 0.1), ConfigError);
}

}  // namespace
}  // namespace talus

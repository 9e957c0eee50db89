#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

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

std::vector<double> some_coefficients(const CirculantEmbedding& field) {
  std::vector<double> xi(field.terms());
  for (std::size_t k = 0; k < xi.size(); ++k) xi[k] = std::sin(1.7 * static_cast<double>(k * k % 97));
  return xi;
}

TEST(CirculantEmbedding, CovarianceOnNodesIsExact) {
  const CirculantEmbedding field(anisotropic(0.5), oblong, 0.1);
  const std::vector<Vec2> nodes{{-1, 2}, {-0.5, 2}, {1.5, 2}, {0, 2.5}, {-1, 3.5}, {1.5, 3.5}, {0.5, 3.0}};
  const auto responses = test::responses(field, nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      EXPECT_NEAR(test::covariance(responses, i, j), exact({1.3}, {0.4}, nodes[i], nodes[j]), 1e-12) << i << ' ' << j;
}

// Points and cells between nodes, across the edge of the domain and beyond it; cells finer and coarser than the grid.
TEST(CirculantEmbedding, VarianceIsExactEverywhere) {
  const std::vector<Vec2> points{{-1, 2}, {-0.93, 2.11}, {0.125, 2.375}, {0.4, 3.3}, {1.5, 3.5}, {1.7, 1.4}, {9, 9}};
  for (double cell : {0.0, 0.04, 0.3, 1.1}) {
    FieldSpec spec = anisotropic(0.25);
    spec.cell_average = cell > 0;
    const CirculantEmbedding field(spec, oblong, cell);
    const double variance = ExponentialCovariance{1.3, cell}(0) * ExponentialCovariance{0.4, cell}(0);
    EXPECT_DOUBLE_EQ(field.variance(), variance);
    const auto responses = test::responses(field, points);
    const auto stated = field.variance(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(test::covariance(responses, i, i), variance, 1e-12) << cell << ' ' << i;
      EXPECT_DOUBLE_EQ(stated[i], variance);
    }
  }
}

// The covariance of two points is that of their nodes: off by less than the spacing over ell, and averaged over
// positions by r^2/8 of itself. Cells smooth the error of a single pair.
TEST(CirculantEmbedding, CovarianceBetweenNodesIsWithinTheStatedError) {
  FieldSpec spec{.direction = FieldDirection::x, .ell_x = 0.8, .sampler = FieldSampler::circulant_embedding};
  constexpr double r = grid_fraction;
  constexpr int positions = 100;
  for (double cell : {0.0, 0.3}) {
    spec.cell_average = cell > 0;
    const CirculantEmbedding field(spec, {{0, 0}, {4, 1}}, cell);
    const ExponentialCovariance covariance{spec.ell_x, cell};
    for (double lag : {0.05, 0.1, 0.29, 0.8, 1.63}) {
      std::vector<Vec2> points;
      for (int k = 0; k < positions; ++k) {
        const double x = 1 + (k + 0.5) / positions * r * spec.ell_x;
        points.push_back({x, 0});
        points.push_back({x + lag, 0});
      }
      const auto responses = test::responses(field, points);
      double mean = 0, worst = 0;
      for (std::size_t k = 0; k < positions; ++k) {
        const double error = test::covariance(responses, 2 * k, 2 * k + 1) - covariance(lag);
        mean += error / positions;
        worst = std::max(worst, std::abs(error));
      }
      EXPECT_LT(std::abs(mean), 1.1 * r * r / 8) << cell << ' ' << lag;
      EXPECT_LT(worst, cell > 0 ? r / 5 : r) << cell << ' ' << lag;
    }
  }
}

// What decides is the correlation length: coefficients, grid and values are the same at every particle spacing.
TEST(CirculantEmbedding, IsTheSameFieldAtEverySpacing) {
  const FieldSpec spec{.ell_x = 1.3, .ell_y = 0.4, .sampler = FieldSampler::circulant_embedding};
  const CirculantEmbedding coarse(spec, oblong, 0.4), fine(spec, oblong, 0.2);
  ASSERT_EQ(coarse.terms(), fine.terms());
  std::vector<Vec2> points;
  for (int i = 0; i < 50; ++i) points.push_back({-1 + 0.05 * i, 2 + std::fmod(0.37 * i, 1.5)});
  EXPECT_EQ(coarse.gaussian(points, some_coefficients(coarse)), fine.gaussian(points, some_coefficients(fine)));
}

// The mean over a cell of 0.4 m and the mean of the means over its four quarters are one number, up to their scales.
TEST(CirculantEmbedding, QuartersOfACellAverageToTheCell) {
  const FieldSpec spec{.ell_x = 1.3, .ell_y = 0.4, .sampler = FieldSampler::circulant_embedding, .cell_average = true};
  const CirculantEmbedding coarse(spec, oblong, 0.4), fine(spec, oblong, 0.2);
  const auto xi = some_coefficients(coarse);
  for (Vec2 centre : {Vec2{-0.8, 2.2}, Vec2{0.37, 2.71}, Vec2{1.03, 3.11}}) {
    std::vector<Vec2> quarters;
    for (double x : {-0.1, 0.1})
      for (double y : {-0.1, 0.1}) quarters.push_back({centre.x + x, centre.y + y});
    const auto z = fine.gaussian(quarters, xi);
    EXPECT_NEAR((z[0] + z[1] + z[2] + z[3]) / 4, coarse.gaussian(std::vector{centre}, xi)[0], 0.01);
  }
}

// Rounding does not decide to which of two nodes a point halfway between them belongs.
TEST(CirculantEmbedding, PointsHalfwayBetweenNodesTakeTheUpperOne) {
  const CirculantEmbedding field(anisotropic(0.1), oblong, 0.1);
  const double x = 0.35, y = 2.65;
  const auto z = field.gaussian(std::vector<Vec2>{{x, y}, {x - 1e-9, y + 1e-9}, {x + 1e-9, y - 1e-9}, {0.4, 2.7}},
                                some_coefficients(field));
  for (double value : z) EXPECT_EQ(value, z[0]);
}

TEST(CirculantAxis, NodesAndPeriod) {
  const CirculantAxis whole(0.0, 10.0, 0.1, {0.5});
  EXPECT_EQ(whole.nodes(), 101u);
  EXPECT_EQ(whole.period(), 200u);  // the exponential needs no padding
  EXPECT_EQ(CirculantAxis(0.0, 1.0, 0.3, {0.5}).nodes(), 5u);
}

TEST(CirculantEmbedding, OneDirectionIsConstantAcross) {
  FieldSpec spec = anisotropic(0.25);
  spec.direction = FieldDirection::y;
  const CirculantEmbedding field(spec, oblong, 0.1);
  const std::vector<Vec2> points{{-1, 2.5}, {1.5, 2.5}, {0, 2}, {0, 3.5}};
  const auto responses = test::responses(field, points);
  EXPECT_NEAR(test::covariance(responses, 0, 1), 1, 1e-12);
  EXPECT_NEAR(test::covariance(responses, 2, 3), std::exp(-1.5 / 0.4), 1e-12);
  EXPECT_LT(field.terms(), 20u);
}

TEST(CirculantEmbedding, OutsideTheDomainTheNearestPointCounts) {
  const CirculantEmbedding field(anisotropic(0.25), oblong, 0.1);
  const auto xi = some_coefficients(field);
  const std::vector<Vec2> points{{-9, 9}, {-1, 3.5}, {0.3, 0.0}, {0.3, 2.0}};
  const auto z = field.gaussian(points, xi);
  EXPECT_EQ(z[0], z[1]);
  EXPECT_EQ(z[2], z[3]);
}

TEST(CirculantEmbedding, DefaultGridIsATenthOfTheCorrelationLengths) {
  const auto terms = [](double ell_x, double ell_y) {
    const FieldSpec spec{.ell_x = ell_x, .ell_y = ell_y, .sampler = FieldSampler::circulant_embedding};
    return CirculantEmbedding(spec, {{0, 0}, {10, 8}}, 0.1).terms();
  };
  EXPECT_EQ(terms(5.0, 2.0), 40u * 80u);  // 20 and 40 intervals, twice as many nodes
  EXPECT_EQ(terms(2.5, 2.0), 80u * 80u);
}

/// The spacing that the message of a refused grid names [m].
double spacing_named(const FieldSpec& spec, Box domain) {
  try {
    CirculantEmbedding(spec, domain, 0.1);
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.faults.at(0).pointer, "/random_field/grid_spacing_m");
    const std::string &message = error.faults.at(0).message, words = "a spacing from ";
    return std::stod(message.substr(message.find(words) + words.size()));
  }
  ADD_FAILURE() << "no error";
  return 0;
}

TEST(CirculantEmbedding, RefusesAGridThatIsTooLargeAndNamesASpacingThatFits) {
  for (double ell : {1e-3, 1e-9, 1e-300}) {
    FieldSpec spec{.ell_x = ell, .ell_y = ell, .sampler = FieldSampler::circulant_embedding};
    spec.grid_spacing = spacing_named(spec, oblong);
    EXPECT_NO_THROW(CirculantEmbedding(spec, oblong, 0.1));
    spec.grid_spacing = 0.8 * *spec.grid_spacing;
    spacing_named(spec, oblong);
  }
  FieldSpec line{.direction = FieldDirection::x, .ell_x = 1e-6, .sampler = FieldSampler::circulant_embedding};
  line.grid_spacing = spacing_named(line, oblong);
  EXPECT_NO_THROW(CirculantEmbedding(line, oblong, 0.1));
}

}  // namespace
}  // namespace talus

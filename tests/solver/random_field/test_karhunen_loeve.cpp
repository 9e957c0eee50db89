#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "linear_sampler.hpp"
#include "quadrature.hpp"
#include "random_field/karhunen_loeve.hpp"
#include "random_field/random_field.hpp"

namespace talus {
namespace {

constexpr Box oblong{{-3.0, 2.0}, {7.0, 6.0}};

FieldSpec anisotropic(Truncation truncation, int terms) {
  return {.ell_x = 2.5, .ell_y = 0.6, .truncation = truncation, .terms = terms};
}

std::vector<double> normals(std::size_t count, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> xi(count);
  for (double& value : xi) value = normal(engine);
  return xi;
}

std::vector<Vec2> scattered(std::size_t count, Box box) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> x(box.lo.x, box.hi.x), y(box.lo.y, box.hi.y);
  std::vector<Vec2> points(count);
  for (Vec2& p : points) p = {x(engine), y(engine)};
  return points;
}

std::vector<Vec2> lattice(Box box, double spacing) {
  std::vector<Vec2> points;
  for (double x = box.lo.x + spacing / 2; x < box.hi.x; x += spacing)
    for (double y = box.lo.y + spacing / 2; y < box.hi.y; y += spacing) points.push_back({x, y});
  return points;
}

/// [Z20] Eqs. 11, 22, 23 as they stand, mode by mode.
double naive(Vec2 p, const std::vector<ModePair>& pairs, const FieldSpec& spec, Box box, std::span<const double> xi) {
  const double ax = box.width() / 2, ay = box.height() / 2;
  double z = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto f = exponential_mode(static_cast<int>(pairs[k].ix) + 1, ax, spec.ell_x);
    const auto g = exponential_mode(static_cast<int>(pairs[k].iy) + 1, ay, spec.ell_y);
    z += std::sqrt(f.lambda * g.lambda) * f.value(p.x - box.lo.x - ax) * g.value(p.y - box.lo.y - ay) * xi[k];
  }
  return z;
}

TEST(KarhunenLoeve, SeparableEvaluationEqualsTheTripleLoop) {
  for (Truncation truncation : {Truncation::largest, Truncation::diagonal}) {
    const FieldSpec spec = anisotropic(truncation, 60);
    const KarhunenLoeve field(spec, oblong, 0.1);
    const auto xi = normals(field.terms(), 1);
    std::vector<Vec2> points = scattered(1500, oblong);  // more than one chunk, and with equal coordinates
    for (std::size_t i = 0; i + 7 < points.size(); i += 7) points[i].x = points[i + 7].x;
    for (std::size_t i = 0; i + 5 < points.size(); i += 5) points[i].y = points[i + 5].y;
    const auto z = field.gaussian(points, xi);
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_NEAR(z[i], naive(points[i], field.pairs(), spec, oblong, xi), 1e-12);
  }
}

TEST(KarhunenLoeve, ValueAtAPointDependsOnNoOtherPoint) {
  const KarhunenLoeve field(anisotropic(Truncation::largest, 300), oblong, 0.1);
  const auto xi = normals(field.terms(), 2);
  auto points = scattered(2500, oblong);
  const auto z = field.gaussian(points, xi);
  for (std::size_t i : {0u, 1u, 1234u, 2499u}) EXPECT_EQ(field.gaussian({&points[i], 1}, xi)[0], z[i]);
  EXPECT_TRUE(field.gaussian({}, xi).empty());
}

// [Z20] Fig. 4 and Table 2: one-dimensional fields, for both signs of sigma and both sets of root intervals.
TEST(KarhunenLoeve, FieldsOfFigure4) {
  const std::vector<double> xi_x{-1.9941, -0.2451, 2.0280, -1.3865, -1.2416};
  const std::vector<double> xi_y{-0.9921, 1.0695, -0.7861, -0.9341, 0.0460};
  const double mu = -0.7629;
  std::ifstream file(TALUS_SOURCE_DIR "/tests/solver/random_field/data/kl-fig4.csv");
  std::string line;
  std::getline(file, line);
  int lines = 0;
  for (; std::getline(file, line); ++lines) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    std::string direction;
    double at = 0;
    in >> direction >> at;
    for (RootIntervals intervals : {RootIntervals::complete, RootIntervals::paper})
      for (double sigma : {-0.2289, 0.2289}) {
        double expected = 0;
        ASSERT_TRUE(in >> expected);
        const bool x = direction == "x";
        const FieldSpec spec{.direction = x ? FieldDirection::x : FieldDirection::y,
                             .ell_x = 0.2,
                             .ell_y = 0.2,
                             .terms = 5,
                             .root_intervals = intervals};
        const KarhunenLoeve field(spec, {{0, 0}, {10, 4}}, 0.1);
        const Vec2 point = x ? Vec2{at, 1.3} : Vec2{2.7, at};
        const auto z = field.gaussian({&point, 1}, x ? xi_x : xi_y);
        EXPECT_NEAR(lognormal(z, {&mu, 1}, sigma)[0], expected, 1e-9) << line;
      }
  }
  EXPECT_EQ(lines, 101 + 41);
}

TEST(KarhunenLoeve, AlongOneAxisTheFieldIsConstantAcrossIt) {
  for (FieldDirection direction : {FieldDirection::x, FieldDirection::y}) {
    FieldSpec spec = anisotropic(Truncation::largest, 20);
    spec.direction = direction;
    const KarhunenLoeve field(spec, oblong, 0.1);
    const std::vector<Vec2> points{{1, 3}, {1, 5}, {6, 3}};
    const auto z = field.gaussian(points, normals(20, 4));
    EXPECT_EQ(z[0] == z[1], direction == FieldDirection::x);
    EXPECT_EQ(z[0] == z[2], direction == FieldDirection::y);
  }
}

// The variance averaged over the domain by quadrature, against what is reported from eigenvalues.
TEST(KarhunenLoeve, CapturedVarianceIsTheMeanVarianceOfTheSamples) {
  for (Truncation truncation : {Truncation::largest, Truncation::diagonal})
    for (bool average : {false, true})
      for (RootIntervals intervals : {RootIntervals::complete, RootIntervals::paper}) {
        FieldSpec spec = anisotropic(truncation, 8);
        spec.cell_average = average;
        spec.root_intervals = intervals;
        const KarhunenLoeve field(spec, oblong, 0.4);
        const double integral = integrate(
            [&](double x) {
              return integrate(
                  [&](double y) {
                    const Vec2 point{x, y};
                    return test::covariance(test::responses(field, {&point, 1}), 0, 0);
                  },
                  oblong.lo.y, oblong.hi.y, 4);
            },
            oblong.lo.x, oblong.hi.x, 4);
        EXPECT_NEAR(field.variance(), integral / (10.0 * 4.0), 1e-12);
        const double averaging = field.variance() / field.captured_variance();
        EXPECT_GT(averaging, 0.9);
        EXPECT_LT(averaging, average ? 0.99 : 1 + 1e-14);
      }
}

// Mercer: the covariance of the truncated field tends to the exact one; at a kink-free pair it is close with a few
// thousand modes.
TEST(KarhunenLoeve, CovarianceTendsToTheExponential) {
  const KarhunenLoeve field(anisotropic(Truncation::largest, 4000), oblong, 0.1);
  const std::vector<Vec2> points{{-2.0, 2.5}, {0.5, 3.2}, {0.5, 5.5}, {6.8, 4.0}};
  const auto responses = test::responses(field, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = std::abs(points[i].x - points[j].x), dy = std::abs(points[i].y - points[j].y);
      EXPECT_NEAR(test::covariance(responses, i, j), std::exp(-dx / 2.5 - dy / 0.6), 2e-3);
    }
}

// f_i(-x) f_i(-y) = f_i(x) f_i(y), for both factors are even or both are odd: what [Z20] saw in its Fig. 3d.
TEST(KarhunenLoeve, DiagonalTruncationIsPointSymmetric) {
  const auto largest_difference = [](Truncation truncation) {
    const KarhunenLoeve field(anisotropic(truncation, 12), oblong, 0.1);
    std::vector<Vec2> points = scattered(100, oblong), mirrored = points;
    for (Vec2& p : mirrored) p = Vec2{4.0, 8.0} - p;  // twice the middle of the domain
    const auto xi = normals(12, 5);
    const auto z = field.gaussian(points, xi), m = field.gaussian(mirrored, xi);
    double difference = 0;
    for (std::size_t i = 0; i < z.size(); ++i) difference = std::max(difference, std::abs(z[i] - m[i]));
    return difference;
  };
  EXPECT_LT(largest_difference(Truncation::diagonal), 1e-12);
  EXPECT_GT(largest_difference(Truncation::largest), 0.1);
}

TEST(KarhunenLoeve, CellAverageEqualsTheIntegralOverTheCell) {
  FieldSpec spec = anisotropic(Truncation::largest, 80);
  const double dx = 0.7;
  for (FieldDirection direction : {FieldDirection::xy, FieldDirection::x}) {
    spec.direction = direction;
    spec.cell_average = false;
    const KarhunenLoeve at_points(spec, oblong, dx);
    spec.cell_average = true;
    const KarhunenLoeve averaged(spec, oblong, dx);
    const auto xi = normals(80, 6);
    for (const Vec2 p : {Vec2{0.3, 4.1}, Vec2{-2.5, 2.6}, Vec2{6.0, 5.5}}) {
      const double integral = integrate(
          [&](double x) {
            return integrate(
                [&](double y) {
                  const Vec2 q{x, y};
                  return at_points.gaussian({&q, 1}, xi)[0];
                },
                p.y - dx / 2, p.y + dx / 2, 2);
          },
          p.x - dx / 2, p.x + dx / 2, 2);
      EXPECT_NEAR(averaged.gaussian({&p, 1}, xi)[0], integral / (dx * dx), 1e-11);
    }
  }
}

TEST(KarhunenLoeve, VarianceShareTakesTheLargestModes) {
  FieldSpec spec = anisotropic(Truncation::variance_share, 1);
  spec.variance_share = 0.6;
  const KarhunenLoeve by_share(spec, oblong, 0.1);
  EXPECT_GE(by_share.captured_variance(), 0.6);
  const KarhunenLoeve by_number(anisotropic(Truncation::largest, static_cast<int>(by_share.terms())), oblong, 0.1);
  const auto xi = normals(by_share.terms(), 7);
  const auto points = lattice(oblong, 0.5);
  EXPECT_EQ(by_share.gaussian(points, xi), by_number.gaussian(points, xi));
}

// [Z20] Table 4, five modes: the share that method notes give as 1-10 %.
TEST(KarhunenLoeve, FiveModesCarryAFewPercent) {
  for (double ell : {0.1, 0.5}) {
    const FieldSpec spec{.ell_x = ell, .ell_y = ell, .terms = 5};
    EXPECT_LT(KarhunenLoeve(spec, {{0, 2}, {13, 14}}, 0.1).captured_variance(), 0.1);
  }
}

TEST(KarhunenLoeve, TenThousandModesOnASlide) {
  const FieldSpec spec{.ell_x = 0.5, .ell_y = 0.5, .terms = 10'000};
  const Box slide{{0, 2}, {13, 14}};
  const KarhunenLoeve field(spec, slide, 0.1);
  const auto points = lattice(slide, 0.1);
  const auto z = field.gaussian(points, normals(field.terms(), 8));
  double sum = 0;
  for (double value : z) sum += value * value;
  EXPECT_NEAR(sum / static_cast<double>(z.size()), field.captured_variance(), 0.2);
}

// V = sum_k scale_k^2 f_k^2 is the sum of the squared responses to unit coefficients, inside the domain and beyond it.
TEST(KarhunenLoeve, VarianceAtPoints) {
  const Box domain{{0, 2}, {8, 5}};
  const std::vector<Vec2> points{{0, 2}, {0.1, 2.2}, {0.1, 4.9}, {4, 3.5}, {7.5, 4.9}, {8.2, 5.1}};
  for (const FieldSpec& spec :
       {FieldSpec{.ell_x = 2, .ell_y = 0.7, .terms = 5}, FieldSpec{.ell_x = 2, .truncation = Truncation::diagonal},
        FieldSpec{.ell_x = 2, .ell_y = 0.7, .truncation = Truncation::variance_share, .variance_share = 0.8},
        FieldSpec{.ell_x = 2, .ell_y = 0.7, .terms = 40, .cell_average = true},
        FieldSpec{.direction = FieldDirection::y, .ell_y = 0.7, .root_intervals = RootIntervals::paper}}) {
    const KarhunenLoeve field(spec, domain, 0.5);
    const auto responses = test::responses(field, points);
    const auto variance = field.variance(points);
    ASSERT_EQ(variance.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_NEAR(variance[i], test::covariance(responses, i, i), 1e-13) << i;
  }
}

}  // namespace
}  // namespace talus

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "random_field/property_fields.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

const Box box{{0, 0}, {10, 4}};
const std::vector<FieldMaterial> one_soil{{"soil", {0.5, 4e3, 1900, 500}}};
const std::vector<FieldMaterial> two_soils{{"sand", {0.6, 1e3, 1900, 500}}, {"clay", {0.4, 8e3, 2000, 900}}};

PropertySpec friction(double cov) { return {.property = Property::friction, .cov = cov}; }
PropertySpec cohesion(double cov) { return {.property = Property::cohesion, .cov = cov}; }

FieldSpec spec_of(std::vector<PropertySpec> properties, std::vector<PropertyCorrelation> correlation = {}) {
  return {
      .ell_x = 3, .ell_y = 1, .terms = 6, .properties = std::move(properties), .correlation = std::move(correlation)};
}

const std::vector<Vec2> places{{1.0, 0.5}, {1.2, 0.7}, {9.0, 3.5}};
const std::vector<std::size_t> first_material(3, 0);

/// Moments of two properties at one place over 20,000 draws.
struct Moments {
  double mean[2] = {}, stdev[2] = {}, correlation = 0, error[2] = {};
};
Moments moments(const PropertyFields& fields, std::size_t place, std::size_t material) {
  constexpr int n = 20'000;
  const std::vector<Vec2> at{places[place]};
  const std::vector<std::size_t> in{material};
  std::vector<double> x[2];
  for (int k = 0; k < n; ++k) {
    const auto values = fields.values(at, in, fields.draw(29, static_cast<std::uint64_t>(k)));
    for (int p = 0; p < 2; ++p) x[p].push_back(values[static_cast<std::size_t>(p)][0]);
  }
  Moments m;
  for (int p = 0; p < 2; ++p) {
    m.mean[p] = std::accumulate(x[p].begin(), x[p].end(), 0.0) / n;
    for (const double v : x[p]) m.stdev[p] += (v - m.mean[p]) * (v - m.mean[p]) / n;
    m.stdev[p] = std::sqrt(m.stdev[p]);
    m.error[p] = m.stdev[p] / std::sqrt(n);
  }
  for (int k = 0; k < n; ++k)
    m.correlation += (x[0][static_cast<std::size_t>(k)] - m.mean[0]) * (x[1][static_cast<std::size_t>(k)] - m.mean[1]) /
                     (n * m.stdev[0] * m.stdev[1]);
  return m;
}

// Six terms carry about half of the variance, by place differently; mean, coefficient of variation and correlation come
// out as asked for at each place all the same. 20,000 draws; bounds of z = 4: the mean 4 stdev/sqrt(n), the standard
// deviation 3 % (4 times the error 0.72 % of a lognormal of COV 0.4, kurtosis below 8), the correlation 0.05 (4 times
// 1.2 %, twice that of a normal pair).
TEST(PropertyFields, MomentsComeOutWhateverTheTruncation) {
  const PropertyFields fields(
      spec_of({friction(0.15), cohesion(0.4)}, {{Property::friction, Property::cohesion, -0.6}}), one_soil, box, 0.1);
  EXPECT_LT(fields.captured_variance(), 0.75);
  for (const std::size_t place : {0, 2}) {
    const Moments m = moments(fields, place, 0);
    EXPECT_NEAR(m.mean[0], 0.5, 4 * m.error[0]);
    EXPECT_NEAR(m.mean[1], 4e3, 4 * m.error[1]);
    EXPECT_NEAR(m.stdev[0], 0.15 * 0.5, 0.03 * 0.15 * 0.5);
    EXPECT_NEAR(m.stdev[1], 0.4 * 4e3, 0.03 * 0.4 * 4e3);
    EXPECT_NEAR(m.correlation, -0.6, 0.05);
  }
}

// What averaging takes away is not restored: the mean stays, and the coefficient of variation is the one stated.
TEST(PropertyFields, AveragingReducesTheVariance) {
  FieldSpec spec = spec_of({friction(0.4), cohesion(0.4)});
  spec.cell_average = true;
  spec.terms = 200;
  const PropertyFields fields(spec, one_soil, box, 1.0);
  EXPECT_LT(fields.averaging(), 0.8);
  const Moments m = moments(fields, 0, 0);
  EXPECT_NEAR(m.mean[1], 4e3, 4 * m.error[1]);
  EXPECT_NEAR(m.stdev[1], fields.drawn(1, 0).stdev, 0.03 * fields.drawn(1, 0).stdev);
  EXPECT_NEAR(fields.drawn(1, 0).cov(), std::sqrt(std::expm1(std::log1p(0.16) * fields.averaging())), 1e-12);
}

TEST(PropertyFields, FrictionKeepsItsDrawsBesideOthers) {
  const FieldSpec alone = spec_of({friction(0.2)});
  const FieldSpec both = spec_of({friction(0.2), cohesion(0.4)}, {{Property::friction, Property::cohesion, -0.6}});
  const PropertyFields a(alone, one_soil, box, 0.1), b(both, one_soil, box, 0.1);
  const std::vector<double> xi_a = a.draw(5, 7), xi_b = b.draw(5, 7);
  EXPECT_EQ(xi_a, RandomField(alone, box, 0.1).draw(5, 7));
  EXPECT_TRUE(std::equal(xi_a.begin(), xi_a.end(), xi_b.begin()));
  EXPECT_EQ(a.values(places, first_material, xi_a)[0], b.values(places, first_material, xi_b)[0]);
}

// One list: properties in order, each with as many as a field takes, or one.
TEST(PropertyFields, LayoutOfTheCoefficients) {
  PropertySpec once = cohesion(0.4);
  once.varies = Varies::once;
  PropertySpec layered{.property = Property::viscosity, .cov = 0.2, .layers = Layers::independent};
  const auto blocks = property_blocks(spec_of({friction(0.2), once, layered}), two_soils, 6);
  ASSERT_EQ(blocks.size(), 4u);
  EXPECT_EQ(blocks[0].count, 6u);
  EXPECT_EQ(blocks[1].offset, 6u);
  EXPECT_EQ(blocks[1].count, 1u);
  EXPECT_EQ(blocks[2].offset, 7u);
  EXPECT_EQ(blocks[3].offset, 13u);
  EXPECT_EQ(coefficients(blocks), 19u);
  EXPECT_EQ(blocks[0].key, 0u);
  EXPECT_EQ(blocks[1].key, 1u);
  EXPECT_EQ(blocks[2].key, 3u);
  EXPECT_EQ(blocks[3].key, 3u + 16u);
}

TEST(PropertyFields, OnceIsOneValueAndOneFieldIsSmooth) {
  PropertySpec once = cohesion(0.4);
  once.varies = Varies::once;
  const PropertyFields fields(spec_of({friction(0.2), once}), one_soil, box, 0.1);
  const auto values = fields.values(places, first_material, fields.draw(1, 1));
  EXPECT_EQ(values[1][0], values[1][2]);
  EXPECT_NE(values[0][0], values[0][2]);
}

// Independent layers: the coefficients of one do not reach the other. One field: the same normal numbers in both, each
// with its own mean.
TEST(PropertyFields, Layers) {
  PropertySpec own = cohesion(0.4);
  own.layers = Layers::independent;
  const PropertyFields apart(spec_of({own}), two_soils, box, 0.1),
      through(spec_of({cohesion(0.4)}), two_soils, box, 0.1);
  const std::vector<Vec2> twice{places[0], places[0]};
  const std::vector<std::size_t> materials{0, 1};
  for (const std::size_t layer : {0, 1}) {
    std::vector<double> xi(apart.terms(), 0.0);
    xi[6 * layer] = 1.0;
    const auto values = apart.values(twice, materials, xi)[0];
    const double medians[] = {1e3 / std::sqrt(1.16), 8e3 / std::sqrt(1.16)};
    EXPECT_GT(std::abs(values[layer] / medians[layer] - 1), 0.01);
    EXPECT_NEAR(values[1 - layer], medians[1 - layer], 1e-9);
  }
  const auto same = through.values(twice, materials, through.draw(1, 2))[0];
  EXPECT_NEAR(same[1] / same[0], 8.0, 1e-12);
}

TEST(PropertyFields, AMaterialByName) {
  PropertySpec clay = cohesion(0.4);
  clay.material = "clay";
  const PropertyFields fields(spec_of({clay}), two_soils, box, 0.1);
  EXPECT_FALSE(fields.laws().applies(0, 0));
  EXPECT_TRUE(fields.laws().applies(0, 1));
  EXPECT_EQ(fields.terms(), 6u);
}

// Over the realizations, the first coefficient of every block falls once into each of 50 intervals of equal
// probability.
TEST(PropertyFields, LatinHypercubeStratifiesEveryBlock) {
  PropertySpec once = cohesion(0.4);
  once.varies = Varies::once;
  const PropertyFields fields(spec_of({friction(0.2), once}), one_soil, box, 0.1);
  std::vector<int> hit[2];
  for (auto& h : hit) h.assign(50, 0);
  int alike = 0;
  for (std::uint64_t k = 0; k < 50; ++k) {
    const auto xi = fields.draw_stratified(9, 50, k, 3);
    alike += std::abs(xi[0] - xi[6]) < 0.1;
    for (const auto& [block, place] : {std::pair(0, 0), std::pair(1, 6)}) {
      const double p = 0.5 * std::erfc(-xi[static_cast<std::size_t>(place)] / std::sqrt(2));
      ++hit[block][static_cast<std::size_t>(50 * p)];
    }
  }
  EXPECT_EQ(hit[0], std::vector<int>(50, 1));
  EXPECT_EQ(hit[1], std::vector<int>(50, 1));
  EXPECT_LT(alike, 15);  // paired at random: 3 of 50 expected
}

std::vector<Fault> faults_of(const FieldSpec& spec, const std::vector<FieldMaterial>& materials) try {
  const PropertyLaws laws(spec, materials);
  return {};
} catch (const ConfigError& e) {
  return e.faults;
}

TEST(PropertyLaws, NamesWhatIsWrong) {
  const Property f = Property::friction, c = Property::cohesion, v = Property::viscosity;
  const PropertySpec viscosity{.property = v, .cov = 0.3};
  auto faults =
      faults_of(spec_of({friction(0.2), cohesion(0.3), viscosity}, {{f, c, 0.9}, {f, v, 0.9}, {c, v, -0.9}}), one_soil);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].pointer, "/random_field/correlation");
  EXPECT_NE(faults[0].message.find("not positive definite; the nearest that is: friction and cohesion 0.49"),
            std::string::npos)
      << faults[0].message;
  faults = faults_of(spec_of({friction(0.2), cohesion(1.3)}, {{f, c, -0.9}}), one_soil);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].message.find("they allow -0."), std::string::npos) << faults[0].message;
  // Possible as they stand, but not beneath these marginals.
  faults = faults_of(spec_of({friction(1.0), cohesion(1.0), viscosity}, {{f, c, -0.48}, {f, v, 0.48}, {c, v, 0.5}}),
                     one_soil);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].message.find("the nearest that can: friction and cohesion -0."), std::string::npos)
      << faults[0].message;
  PropertySpec once = cohesion(0.3);
  once.varies = Varies::once;
  faults = faults_of(spec_of({friction(0.2), once}, {{f, c, 0.5}}), one_soil);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].pointer, "/random_field/correlation/0");
  faults = faults_of(spec_of({friction(0.2)}, {{f, c, 0.5}}), one_soil);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].pointer, "/random_field/correlation/0/between");
  PropertySpec peat = cohesion(0.3);
  peat.material = "peat";
  faults = faults_of(spec_of({peat}), two_soils);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].message.find("they are: sand, clay"), std::string::npos) << faults[0].message;
}

}  // namespace
}  // namespace talus

// Data on several properties: kriging of all fields together, against closed forms, and as what is drawn.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "random_field/nataf.hpp"
#include "random_field/property_fields.hpp"

namespace talus {
namespace {

const Box box{{0, 0}, {12, 3}};
const std::vector<FieldMaterial> one_soil{{"soil", {0.5, 4e3, 1900, 500}}};
constexpr double rho = -0.6;

/// Friction (lognormal) and cohesion (normal above 0), correlated.
FieldSpec c_phi(FieldSampler sampler = FieldSampler::circulant_embedding) {
  return {.ell_x = 1.5,
          .ell_y = 1,
          .sampler = sampler,
          .terms = 30,
          .properties = {{.property = Property::friction, .cov = 0.15},
                         {.property = Property::cohesion, .marginal = MarginalKind::normal, .cov = 0.3}},
          .correlation = {{Property::friction, Property::cohesion, rho}}};
}

const std::vector<PropertyDatum> data{{.property = 0, .x = {1, 1}, .value = 0.6, .error = 0.03},
                                      {.property = 1, .x = {1.5, 1}, .value = 6e3, .error = 500},
                                      {.property = 1, .x = {3, 2}, .value = 2e3, .error = 0},
                                      {.property = 0, .x = {3, 2}, .value = 0.55, .error = 0},
                                      {.property = 0, .x = {6, 1.5}, .value = 0.4, .error = 0}};

PropertyFields fields_of(const FieldSpec& spec, std::span<const PropertyDatum> with, double dx = 0.1) {
  return PropertyFields(spec, one_soil, box, dx, with);
}

// Exact data on both properties are met by every realization, at one point too, whatever the sampler and the
// covariance.
TEST(PropertyData, RealizationsMeetExactData) {
  const std::vector<PropertyDatum> exact(data.begin() + 2, data.end());
  std::vector<Vec2> places;
  for (const PropertyDatum& datum : exact) places.push_back(datum.x);
  const std::vector<std::size_t> materials(places.size(), 0);
  for (const FieldSampler sampler : {FieldSampler::karhunen_loeve, FieldSampler::circulant_embedding})
    for (const Covariance family : {Covariance::exponential, Covariance::matern_3_2}) {
      FieldSpec spec = c_phi(sampler);
      spec.covariance = family;
      spec.dip = 0.3;
      const PropertyFields fields = fields_of(spec, exact);
      ASSERT_EQ(fields.data(), 3u);
      const auto values = fields.values(places, materials, fields.draw(1, 3));
      for (std::size_t i = 0; i < exact.size(); ++i)
        EXPECT_NEAR(values[exact[i].property][i] / exact[i].value, 1.0, 1e-9);
    }
}

/// Kriging of the stacked normal numbers at one point, written out: their covariances are R_kl rho(x - x').
struct Kriged {
  double mean, variance;
};
Kriged kriged(const PropertyFields& fields, const FieldSpec& spec, std::size_t k, Vec2 x) {
  const PropertyLaws& laws = fields.laws();
  const double r = gaussian_correlation(laws.marginal(0, 0), laws.marginal(1, 0), rho);
  const auto n = static_cast<Eigen::Index>(data.size());
  const auto covariance = [&](std::size_t p, Vec2 a, std::size_t q, Vec2 b) {
    return (p == q ? 1.0 : r) * std::exp(-std::abs(a.x - b.x) / spec.ell_x - std::abs(a.y - b.y) / spec.ell_y);
  };
  Eigen::MatrixXd c(n, n);
  Eigen::VectorXd to(n), z(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PropertyDatum& a = data[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const PropertyDatum& b = data[static_cast<std::size_t>(j)];
      c(i, j) = covariance(a.property, a.x, b.property, b.x);
    }
    const Marginal& law = laws.marginal(a.property, 0);
    z[i] = law.normal_number(a.value);
    c(i, i) += std::pow(a.error / law.slope(z[i]), 2);
    to[i] = covariance(k, x, a.property, a.x);
  }
  const Eigen::VectorXd weights = c.fullPivLu().solve(to);
  return {weights.dot(z), 1 - weights.dot(to)};
}

// Places on nodes of the sampler's grid, 0.5 m apart, so that the drawn covariance is that of the formula.
const std::vector<Vec2> places{{1, 1}, {1.5, 1}, {2, 1.5}, {4.5, 2}, {11, 1}};

TEST(PropertyData, MedianAndSpreadAreThoseOfJointKriging) {
  const FieldSpec spec = c_phi();
  const PropertyFields fields = fields_of(spec, data);
  const std::vector<std::size_t> materials(places.size(), 0);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto spread = fields.spread(k, places, materials);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Kriged wanted = kriged(fields, spec, k, places[i]);
      const Marginal& law = fields.laws().marginal(k, 0);
      EXPECT_NEAR(law.normal_number(spread.median[i]), wanted.mean, 1e-8) << k << ' ' << i;
      EXPECT_NEAR(spread.stdev[i], law.slope(wanted.mean) * std::sqrt(wanted.variance), 1e-6 * law.slope(0))
          << k << ' ' << i;
    }
  }
}

// 20,000 draws. At and near the data the normal numbers have the mean and the variance of joint kriging; at (11, 1),
// 3.3 correlation lengths from the nearest datum and 6.7 from the others, mean, standard deviation and correlation of
// the properties are nearly those of the soil without data. Bounds of z = 4.5 standard errors (20 comparisons): of a
// mean s/sqrt(n), of a variance v sqrt(2/n), of the correlation (1 - rho^2)/sqrt(n), doubled as the marginals are not
// normal.
TEST(PropertyData, DrawsHaveTheMomentsOfJointKriging) {
  constexpr int n = 20'000;
  constexpr double z_bound = 4.5;
  FieldSpec spec = c_phi();
  spec.grid_spacing = 0.5;
  const PropertyFields fields = fields_of(spec, data);
  const std::vector<std::size_t> materials(places.size(), 0);
  std::vector<std::vector<double>> sum(2, std::vector<double>(places.size())), squares = sum;
  double values[2] = {}, value_squares[2] = {}, product = 0;
  const std::size_t away = places.size() - 1;
  for (int draw = 0; draw < n; ++draw) {
    const auto x = fields.values(places, materials, fields.draw(11, static_cast<std::uint64_t>(draw)));
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        const double z = fields.laws().marginal(k, 0).normal_number(x[k][i]);
        sum[k][i] += z;
        squares[k][i] += z * z;
      }
      values[k] += x[k][away];
      value_squares[k] += x[k][away] * x[k][away];
    }
    product += x[0][away] * x[1][away];
  }
  double stdev[2];
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Kriged wanted = kriged(fields, spec, k, places[i]);
      const double mean = sum[k][i] / n, variance = squares[k][i] / n - mean * mean;
      EXPECT_NEAR(mean, wanted.mean, z_bound * std::sqrt(wanted.variance / n)) << k << ' ' << i;
      EXPECT_NEAR(variance, wanted.variance, z_bound * wanted.variance * std::sqrt(2.0 / n)) << k << ' ' << i;
    }
    stdev[k] = std::sqrt(value_squares[k] / n - values[k] / n * values[k] / n);
    const Marginal& law = fields.laws().marginal(k, 0);
    EXPECT_NEAR(values[k] / n, law.mean, law.stdev * (0.05 + z_bound / std::sqrt(n)));  // rho(3.3 ell) z = 0.04
    EXPECT_NEAR(stdev[k] / law.stdev, 1.0, 0.02 + z_bound * std::sqrt(1.0 / n));
  }
  const double correlation = (product / n - values[0] / n * values[1] / n) / (stdev[0] * stdev[1]);
  EXPECT_NEAR(correlation, rho, 2 * z_bound * (1 - rho * rho) / std::sqrt(n));
}

// The fields are linear in xi, so their variance is known without sampling: also truncated, averaged and dipping. The
// lognormal marginal makes z linear in the logarithm.
TEST(PropertyData, VarianceIsThatOfTheResponses) {
  for (const double cell : {0.0, 0.5})
    for (const Covariance family : {Covariance::exponential, Covariance::squared_exponential}) {
      FieldSpec spec = c_phi(FieldSampler::karhunen_loeve);
      spec.properties[1].marginal = MarginalKind::lognormal;
      spec.covariance = family;
      spec.dip = 0.2;
      spec.cell_average = cell > 0;
      const PropertyFields fields = fields_of(spec, data, cell);
      const std::vector<std::size_t> materials(places.size(), 0);
      const auto logarithms = [&](std::size_t unit) {
        std::vector<double> xi(fields.terms(), 0.0);
        if (unit < xi.size()) xi[unit] = 1;
        auto x = fields.values(places, materials, xi);
        for (auto& row : x)
          for (double& value : row) value = std::log(value);
        return x;
      };
      const auto mean = logarithms(fields.terms());
      std::vector<std::vector<double>> variance(2, std::vector<double>(places.size()));
      for (std::size_t unit = 0; unit < fields.terms(); ++unit) {
        const auto x = logarithms(unit);
        for (std::size_t k = 0; k < 2; ++k)
          for (std::size_t i = 0; i < places.size(); ++i) variance[k][i] += std::pow(x[k][i] - mean[k][i], 2);
      }
      for (std::size_t k = 0; k < 2; ++k) {
        const auto spread = fields.spread(k, places, materials);
        for (std::size_t i = 0; i < places.size(); ++i)
          EXPECT_NEAR(spread.stdev[i] / spread.median[i], std::sqrt(variance[k][i]), 1e-6) << cell << ' ' << k << i;
      }
    }
}

// A nugget is noise to the data, the same for friction and cohesion measured at one point: z_c given z_f there. Without
// it the pair would be met exactly; with it the conditional variance of each is that of two values of correlation r,
// both observed with the smooth share 1 - n: 4,000 draws, z = 5.
TEST(PropertyData, ANuggetIsNoiseToTheData) {
  constexpr int n = 4000;
  FieldSpec spec = c_phi();
  spec.nugget = 0.3;
  spec.grid_spacing = 0.5;
  const std::vector<PropertyDatum> pair(data.begin() + 2, data.begin() + 4);
  const PropertyFields fields = fields_of(spec, pair);
  const std::vector<Vec2> at{pair[0].x};
  const std::vector<std::size_t> in{0};
  for (std::size_t k = 0; k < 2; ++k) {
    const Marginal& law = fields.laws().marginal(k, 0);
    double sum = 0, squares = 0;
    for (int draw = 0; draw < n; ++draw) {
      const double z = law.normal_number(fields.values(at, in, fields.draw(2, static_cast<std::uint64_t>(draw)))[k][0]);
      sum += z;
      squares += z * z;
    }
    // Y | Y + noise = z: mean (1 - n) z, variance (1 - n) n, of each property for itself since the noise of both has
    // the correlation of both; then noise of its own.
    const double smooth = 1 - spec.nugget, variance = smooth * spec.nugget + spec.nugget;
    const double mean = smooth * law.normal_number(pair[k == 0 ? 1 : 0].value);
    EXPECT_NEAR(sum / n, mean, 5 * std::sqrt(variance / n)) << k;
    EXPECT_NEAR(squares / n - sum / n * sum / n, variance, 5 * variance * std::sqrt(2.0 / n)) << k;
    const auto spread = fields.spread(k, at, in);
    EXPECT_NEAR(spread.stdev[0], law.slope(mean) * std::sqrt(variance), 1e-6 * law.slope(0));
  }
}

// A datum in one of two independent layers says nothing of the other.
TEST(PropertyData, IndependentLayersKeepTheirDataApart) {
  const std::vector<FieldMaterial> two{{"sand", {0.6, 1e3, 1900, 500}}, {"clay", {0.4, 8e3, 2000, 900}}};
  FieldSpec spec = c_phi();
  for (PropertySpec& p : spec.properties) p.layers = Layers::independent;
  const std::vector<PropertyDatum> in_clay{{.property = 1, .material = 1, .x = {3, 2}, .value = 1e4}};
  const PropertyFields fields(spec, two, box, 0.1, in_clay);
  const std::vector<Vec2> twice{{3, 2}, {3, 2}};
  const std::vector<std::size_t> materials{0, 1};
  const auto cohesion = fields.spread(1, twice, materials), friction = fields.spread(0, twice, materials);
  EXPECT_NEAR(cohesion.median[0], fields.laws().marginal(1, 0).value(0), 1e-9);
  EXPECT_NEAR(cohesion.median[1], 1e4, 1e-5);
  EXPECT_LT(friction.median[1], fields.laws().marginal(0, 1).value(0));  // more cohesion, less friction
  EXPECT_EQ(friction.median[0], fields.laws().marginal(0, 0).value(0));
}

TEST(PropertyLaws, SaysWhyADatumCannotBeMet) {
  FieldSpec spec = c_phi();
  spec.properties.push_back({.property = Property::viscosity, .cov = 0.3, .varies = Varies::once});
  const PropertyLaws laws(spec, one_soil);
  EXPECT_EQ(laws.unmet(data[0]), "");
  const auto holds = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(
      holds(laws.unmet({.property = 1, .x = {1, 1}, .value = -1.0}), "lies outside the distribution of cohesion"));
  EXPECT_TRUE(holds(laws.unmet({.property = 2, .x = {1, 1}, .value = 500}), "viscosity does not vary in space"));
}

}  // namespace
}  // namespace talus

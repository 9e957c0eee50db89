#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "random_field/circulant_embedding.hpp"
#include "random_field/karhunen_loeve.hpp"
#include "random_field/random_field.hpp"
#include "random_field/stream.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

constexpr Box slide{{0.0, 2.0}, {8.0, 5.0}};
const std::vector<Vec2> points{{0.1, 2.2}, {4.4, 3.3}, {7.5, 4.9}};

std::vector<std::string> pointers_of_faults(const FieldSpec& spec, Box box = slide, double dx = 0.1) {
  std::vector<std::string> pointers;
  try {
    RandomField(spec, box, dx);
  } catch (const ConfigError& error) {
    for (const Fault& fault : error.faults) pointers.push_back(fault.pointer);
  }
  return pointers;
}

TEST(RandomField, IsTheKarhunenLoeveExpansion) {
  const FieldSpec spec{.ell_x = 2.0, .ell_y = 0.7, .terms = 30, .cell_average = true};
  const RandomField field(spec, slide, 0.2);
  const KarhunenLoeve expansion(spec, slide, 0.2);
  EXPECT_EQ(field.terms(), 30u);
  EXPECT_EQ(field.captured_variance(), expansion.captured_variance());
  EXPECT_EQ(field.variance(), expansion.variance());
  const auto xi = field.draw(1, 2);
  EXPECT_EQ(field.gaussian(points, xi), expansion.gaussian(points, xi));
}

TEST(RandomField, IsTheCirculantEmbedding) {
  const FieldSpec spec{.sampler = FieldSampler::circulant_embedding};
  const RandomField field(spec, slide, 0.25);
  const CirculantEmbedding embedding(spec, slide, 0.25);
  EXPECT_EQ(field.terms(), embedding.terms());
  EXPECT_EQ(field.captured_variance(), 1);
  EXPECT_EQ(field.variance(), 1);
  const auto xi = field.draw(1, 2);
  EXPECT_EQ(field.gaussian(points, xi), embedding.gaussian(points, xi));
}

TEST(RandomField, GivenDomainOverridesTheSlide) {
  FieldSpec spec{.terms = 9, .domain = Box{{-2, 0}, {20, 9}}};
  const RandomField given(spec, slide, 0.1);
  spec.domain.reset();
  const RandomField same(spec, {{-2, 0}, {20, 9}}, 0.1), other(spec, slide, 0.1);
  EXPECT_EQ(given.captured_variance(), same.captured_variance());
  EXPECT_NE(given.captured_variance(), other.captured_variance());
}

TEST(Draw, DoesNotDependOnTheNumberOfTerms) {
  const RandomField few({.terms = 5}, slide, 0.1), many({.terms = 500}, slide, 0.1);
  const auto a = few.draw(42, 7), b = many.draw(42, 7);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
  for (std::size_t k = 0; k < b.size(); ++k) EXPECT_EQ(b[k], standard_normal(42, 7, static_cast<std::uint32_t>(k)));
}

TEST(Draw, DiffersBySeedAndRealization) {
  const RandomField field({.terms = 3}, slide, 0.1);
  EXPECT_EQ(field.draw(1, 2), field.draw(1, 2));
  EXPECT_NE(field.draw(1, 2), field.draw(1, 3));
  EXPECT_NE(field.draw(1, 2), field.draw(2, 2));
  EXPECT_NE(field.draw(1, 2), field.draw(2, 1));
  EXPECT_NE(field.draw(1, 2), field.draw(1 + (std::uint64_t{1} << 32), 2));
  EXPECT_NE(field.draw(1, 2), field.draw(1, 2 + (std::uint64_t{1} << 32)));
}

TEST(DrawStratified, ReplacesTheLeadingModes) {
  const RandomField field({.terms = 6}, slide, 0.1);
  const auto plain = field.draw(1, 4), xi = field.draw_stratified(1, 10, 4, 2),
             leading = stratified_normals(1, 10, 4, 2);
  EXPECT_TRUE(std::equal(leading.begin(), leading.end(), xi.begin()));
  EXPECT_TRUE(std::equal(plain.begin() + 2, plain.end(), xi.begin() + 2));
  EXPECT_EQ(field.draw_stratified(1, 10, 4, 99), stratified_normals(1, 10, 4, 6));
}

TEST(Draw, GivenCoefficientsAreUsedInEveryRealization) {
  const FieldSpec spec{.terms = 3, .xi = {0.5, -1.0, 2.0}};
  const RandomField field(spec, slide, 0.1);
  EXPECT_EQ(field.draw(1, 2), spec.xi);
  EXPECT_EQ(field.draw(3, 4), spec.xi);
  EXPECT_EQ(field.draw_stratified(3, 10, 4, 2), spec.xi);
}

TEST(RandomField, GivenCoefficientsMustFit) {
  EXPECT_EQ(pointers_of_faults({.terms = 4, .xi = {1, 2, 3}}), std::vector<std::string>{"/random_field/xi"});
  try {
    RandomField({.terms = 4, .xi = {1, 2, 3}}, slide, 0.1);
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "/random_field/xi: has 3 coefficients, the field takes 4");
  }
}

TEST(RandomField, AShareThatTakesTooManyModesIsAFault) {
  const FieldSpec spec{.truncation = Truncation::variance_share, .variance_share = 0.9999999};
  EXPECT_EQ(pointers_of_faults(spec), std::vector<std::string>{"/random_field/variance_share"});
}

TEST(RandomField, AlongOneAxisTheOtherMayBeWithoutExtent) {
  const Box flat{{0, 3}, {8, 3}};
  EXPECT_EQ(pointers_of_faults({.direction = FieldDirection::x, .ell_y = -1}, flat), std::vector<std::string>{});
  EXPECT_EQ(pointers_of_faults({.direction = FieldDirection::y}, flat),
            std::vector<std::string>{"/random_field/domain_m"});
  EXPECT_EQ(pointers_of_faults({}, flat), std::vector<std::string>{"/random_field/domain_m"});
}

TEST(Gaussian, RefusesCoefficientsThatDoNotFit) {
  const RandomField field({.terms = 3}, slide, 0.1);
  EXPECT_THROW(field.gaussian(points, std::vector<double>(2)), std::invalid_argument);
}

TEST(Gaussian, IsLinearInTheCoefficients) {
  const RandomField field({.terms = 40}, slide, 0.1);
  auto xi = field.draw(5, 6);
  const auto z = field.gaussian(points, xi);
  std::transform(xi.begin(), xi.end(), xi.begin(), std::negate<>());
  const auto mirrored = field.gaussian(points, xi);
  for (std::size_t i = 0; i < z.size(); ++i) EXPECT_EQ(mirrored[i], -z[i]);
}

}  // namespace
}  // namespace talus

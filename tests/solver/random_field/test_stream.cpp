#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdint>
#include <set>

#include "random_field/stream.hpp"

namespace talus {
namespace {

// Known answers of Philox4x32-10 published with Random123 (kat_vectors): counter, key, result.
TEST(Philox, KnownAnswers) {
  using Counter = r123::Philox4x32::ctr_type;
  using Key = r123::Philox4x32::key_type;
  const r123::Philox4x32 philox;
  const auto ones = 0xffffffffu;
  EXPECT_EQ(philox(Counter{{0, 0, 0, 0}}, Key{{0, 0}}), (Counter{{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}}));
  EXPECT_EQ(philox(Counter{{ones, ones, ones, ones}}, Key{{ones, ones}}),
            (Counter{{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}}));
  EXPECT_EQ(philox(Counter{{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, Key{{0xa4093822, 0x299f31d0}}),
            (Counter{{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}));
}

// References from an independent Philox4x32-10 in Python: key (seed low, high), counter (mode, stream, index low,
// high), uniform = (word >> 12 + 1/2) 2^-52 of words (0,1) and (2,3). A change here changes every realization of every
// study.
TEST(Uniforms, KeysAndLayout) {
  const auto zero = uniforms(0, 0, 0, Stream::field);
  EXPECT_EQ(zero[0], 0.8805201978886142);
  EXPECT_EQ(zero[1], 0.6054818538799213);
  const auto large = uniforms(0x123456789abcdef0u, 0xfedcba9876543210u, 7, Stream::field);
  EXPECT_EQ(large[0], 0.4100609288642071);
  EXPECT_EQ(large[1], 0.666838341479523);
  EXPECT_EQ(uniforms(5, 6, 7, Stream::strata)[0], 0.9391657535134209);
  EXPECT_EQ(uniforms(5, 6, 7, Stream::jitter)[1], 0.2954025986923362);
}

TEST(StandardNormal, BoxMullerOfTheUniforms) {
  EXPECT_NEAR(standard_normal(0, 0, 0), -0.3976675384441824, 1e-15);
  EXPECT_NEAR(standard_normal(1, 2, 3), -0.07194076360401729, 1e-15);
  EXPECT_NEAR(standard_normal(0x123456789abcdef0u, 0xfedcba9876543210u, 7), -0.6663784984916483, 1e-15);
}

// Bounds: z = 5 standard errors, false alarm 6e-7 a comparison.
TEST(StandardNormal, Moments) {
  constexpr int n = 100'000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  for (int i = 0; i < n; ++i) {
    const double x = standard_normal(11, static_cast<std::uint64_t>(i / 100), static_cast<std::uint32_t>(i % 100));
    m1 += x / n;
    m2 += x * x / n;
    m3 += x * x * x / n;
    m4 += x * x * x * x / n;
  }
  const double z = 5, root_n = std::sqrt(n);
  EXPECT_NEAR(m1, 0, z * std::sqrt(1) / root_n);
  EXPECT_NEAR(m2, 1, z * std::sqrt(3 - 1) / root_n);
  EXPECT_NEAR(m3, 0, z * std::sqrt(15) / root_n);
  EXPECT_NEAR(m4, 3, z * std::sqrt(105 - 9) / root_n);
}

// McKay, Beckman & Conover 1979: each of N intervals of probability 1/N is hit once, in every mode.
TEST(StratifiedNormals, EachStratumOnce) {
  constexpr std::uint64_t n = 257;
  const boost::math::normal_distribution<double> normal;
  std::vector<std::set<long>> strata(4);
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto xi = stratified_normals(3, n, i, 4);
    for (std::size_t k = 0; k < 4; ++k) strata[k].insert(static_cast<long>(cdf(normal, xi[k]) * n));
  }
  for (const auto& hit : strata) {
    EXPECT_EQ(hit.size(), n);
    EXPECT_EQ(*hit.begin(), 0);
    EXPECT_EQ(*hit.rbegin(), static_cast<long>(n) - 1);
  }
}

// Reference: the same definition in Python (independent Philox, scipy.stats.norm.ppf).
TEST(StratifiedNormals, Reference) {
  const auto xi = stratified_normals(9, 7, 3, 3);
  EXPECT_NEAR(xi[0], 0.9152277737302682, 1e-13);
  EXPECT_NEAR(xi[1], -0.05734635392225671, 1e-13);
  EXPECT_NEAR(xi[2], -0.18158905572192408, 1e-13);
}

TEST(StratifiedNormals, NumberOfModesDoesNotMatter) {
  const auto few = stratified_normals(9, 50, 20, 2), many = stratified_normals(9, 50, 20, 6);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

TEST(StratifiedNormals, OneRealizationAndNone) {
  EXPECT_TRUE(std::isfinite(stratified_normals(1, 1, 0, 1)[0]));
  EXPECT_THROW(stratified_normals(1, 5, 5, 1), std::invalid_argument);
  EXPECT_THROW(stratified_normals(1, 0, 0, 1), std::invalid_argument);
}

// The mean over the realizations of a smooth monotone function is far more exact than by independent draws, whose
// standard error would be stdev(exp(xi/2)) / sqrt(N) = 0.04.
TEST(StratifiedNormals, MeansConvergeFaster) {
  constexpr std::uint64_t n = 200;
  double mean = 0;
  for (std::uint64_t i = 0; i < n; ++i) mean += std::exp(stratified_normals(21, n, i, 1)[0] / 2) / n;
  EXPECT_NEAR(mean, std::exp(0.125), 0.004);
}

}  // namespace
}  // namespace talus

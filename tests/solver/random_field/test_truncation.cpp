#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "random_field/modes.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

AxisModes wide() { return {0.0, 10.0, 0.5, RootIntervals::complete}; }
AxisModes high() { return {2.0, 6.0, 0.9, RootIntervals::complete}; }

TEST(LargestProducts, AreTheLargestOfAllPairs) {
  constexpr std::size_t side = 120, count = 500;
  AxisModes x = wide(), y = high();
  std::vector<double> all;
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) all.push_back(x[i].lambda * y[j].lambda);
  std::sort(all.begin(), all.end(), std::greater<>());

  const auto pairs = largest_products(x, y, count);
  ASSERT_EQ(pairs.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_EQ(pairs[k].lambda, all[k]);
    EXPECT_EQ(pairs[k].lambda, x[pairs[k].ix].lambda * y[pairs[k].iy].lambda);
  }
  EXPECT_LT(std::max_element(pairs.begin(), pairs.end(), [](auto p, auto q) { return p.ix < q.ix; })->ix, side - 1);
}

TEST(LargestProducts, EachPairOnce) {
  AxisModes x = wide(), y = high();
  std::vector<std::pair<std::size_t, std::size_t>> seen;
  for (const ModePair& pair : largest_products(x, y, 2000)) seen.emplace_back(pair.ix, pair.iy);
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

TEST(LargestProducts, OrderDoesNotDependOnTheirNumber) {
  AxisModes x = wide(), y = high();
  const auto few = largest_products(x, y, 40), many = largest_products(x, y, 400);
  for (std::size_t k = 0; k < few.size(); ++k) EXPECT_TRUE(few[k].ix == many[k].ix && few[k].iy == many[k].iy);
}

TEST(LargestProducts, EqualOnesOfASquareInOrderOfTheXMode) {
  AxisModes x = wide(), y = wide();
  const auto pairs = largest_products(x, y, 3);
  EXPECT_EQ(pairs[1].lambda, pairs[2].lambda);
  EXPECT_EQ(pairs[1].ix, 0u);
  EXPECT_EQ(pairs[2].ix, 1u);
}

TEST(DiagonalProducts, PairEqualNumbers) {
  AxisModes x = wide(), y = high();
  const auto pairs = diagonal_products(x, y, 5);
  ASSERT_EQ(pairs.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(pairs[k].ix, k);
    EXPECT_EQ(pairs[k].iy, k);
    EXPECT_EQ(pairs[k].lambda, x[k].lambda * y[k].lambda);
  }
}

TEST(Truncation, AlongOneAxisTakesTheLeadingModes) {
  for (auto truncate : {largest_products, diagonal_products}) {
    AxisModes x = wide(), none = AxisModes::constant();
    const auto pairs = truncate(none, x, 6);
    ASSERT_EQ(pairs.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(pairs[k].ix, 0u);
      EXPECT_EQ(pairs[k].iy, k);
      EXPECT_EQ(pairs[k].lambda, x[k].lambda);
    }
  }
}

TEST(ProductsReaching, TakesNoMoreThanNeeded) {
  AxisModes x = wide(), y = high();
  for (double share : {0.01, 0.3, 0.8}) {
    auto pairs = products_reaching(x, y, share);
    EXPECT_GE(captured_share(pairs, x, y), share);
    pairs.pop_back();
    EXPECT_LT(captured_share(pairs, x, y), share);
  }
}

TEST(ProductsReaching, SaysWhatTheLimitReaches) {
  AxisModes x = wide(), y = high();
  EXPECT_NO_THROW(products_reaching(x, y, 0.5, 1000));
  try {
    products_reaching(x, y, 0.9999, 1000);
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    ASSERT_EQ(error.faults.size(), 1u);
    EXPECT_EQ(error.faults[0].pointer, "/random_field/variance_share");
    EXPECT_NE(error.faults[0].message.find("0.9999 takes more than 1000 modes"), std::string::npos);
  }
}

}  // namespace
}  // namespace talus

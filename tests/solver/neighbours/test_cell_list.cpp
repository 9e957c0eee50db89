#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <set>

#include "neighbours/cell_list.hpp"

namespace talus {
namespace {

struct Cloud {
  std::vector<double> x, y;
};

Cloud random_cloud(std::size_t n, double width, double height, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> ux(-width, width), uy(0.3, 0.3 + height);
  Cloud c;
  for (std::size_t i = 0; i < n; ++i) {
    c.x.push_back(ux(engine));
    c.y.push_back(uy(engine));
  }
  return c;
}

/// Pairs within `reach`, found through the cells, by original index.
std::set<std::pair<std::uint32_t, std::uint32_t>> pairs_of(const Cloud& c, double reach) {
  CellList cells;
  cells.build(c.x, c.y, reach);
  std::set<std::pair<std::uint32_t, std::uint32_t>> found;
  for (std::uint32_t i = 0; i < c.x.size(); ++i)
    cells.for_ranges(Vec2{c.x[i], c.y[i]}, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) {
        const std::uint32_t j = cells.order()[k];
        if (norm2(Vec2{c.x[i] - c.x[j], c.y[i] - c.y[j]}) >= reach * reach) continue;
        EXPECT_TRUE(found.insert({i, j}).second) << "seen twice";
      }
    });
  return found;
}

class CellListAgainstBruteForce : public testing::TestWithParam<double> {};

TEST_P(CellListAgainstBruteForce, FindsEveryPairOnce) {
  const Cloud c = random_cloud(400, 3.0, 1.1, 7);
  const double reach = GetParam();
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
  for (std::uint32_t i = 0; i < c.x.size(); ++i)
    for (std::uint32_t j = 0; j < c.x.size(); ++j)
      if (norm2(Vec2{c.x[i] - c.x[j], c.y[i] - c.y[j]}) < reach * reach) expected.insert({i, j});
  EXPECT_EQ(pairs_of(c, reach), expected);
}
INSTANTIATE_TEST_SUITE_P(Reaches, CellListAgainstBruteForce, testing::Values(0.01, 0.13, 0.5, 2.0, 50.0));

TEST(CellList, OrderIsAPermutationAndStable) {
  const Cloud c{{0.1, 0.11, 5.0, 0.12, 5.01}, {0.1, 0.1, 0.1, 0.1, 0.1}};
  CellList cells;
  cells.build(c.x, c.y, 1.0);
  EXPECT_EQ(std::vector<std::uint32_t>(cells.order().begin(), cells.order().end()),
            (std::vector<std::uint32_t>{0, 1, 3, 2, 4}));
}

TEST(CellList, SearchesFromOutsideTheGrid) {
  CellList cells;
  cells.build(std::vector<double>{0.0, 1.0}, std::vector<double>{0.0, 0.0}, 0.5);
  std::size_t seen = 0;
  cells.for_ranges(Vec2{-0.4, 0.2}, [&](std::uint32_t begin, std::uint32_t end) { seen += end - begin; });
  EXPECT_GE(seen, 1u);
}

TEST(CellList, OneStrayPointFarAwayDoesNotExhaustMemory) {
  Cloud c = random_cloud(300, 1.0, 1.0, 3);
  c.x.push_back(1e12);
  c.y.push_back(-1e12);
  c.x.push_back(1e12 + 0.01);
  c.y.push_back(-1e12);
  EXPECT_TRUE(pairs_of(c, 0.1).contains({300, 301}));
}

TEST(CellList, EmptyCloud) {
  CellList cells;
  cells.build({}, {}, 1.0);
  cells.for_ranges(Vec2{0, 0}, [](std::uint32_t, std::uint32_t) { FAIL(); });
}

TEST(Permute, FollowsTheOrderAndKeepsTheTail) {
  std::vector<int> v{10, 11, 12, 13};
  std::vector<double> scratch;
  permute(v, std::vector<std::uint32_t>{2, 0, 1}, scratch);
  EXPECT_EQ(v, (std::vector<int>{12, 10, 11, 13}));
}

}  // namespace
}  // namespace talus

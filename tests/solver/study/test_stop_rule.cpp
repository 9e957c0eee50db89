#include <cmath>
#include <cstdint>

#include "statistics/sample.hpp"
#include "studies.hpp"
#include "study/stop_rule.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

/// Influence zones that spread over 2 m without a pattern.
double zone(std::int64_t i) { return 34.0 + 2.0 * std::fmod(0.618033988749895 * static_cast<double>(i + 1), 1.0); }

Plan asking_for(double half_width) {
  Plan p = plan(1000);
  p.study.stop_half_width = half_width;
  return p;
}

std::vector<Record> records(std::int64_t n) {
  std::vector<Record> all;
  for (std::int64_t i = 0; i < n; ++i) all.push_back(i % 9 == 4 ? failed(i, "x") : done(i, zone(i)));
  return all;
}

}  // namespace

TEST(StopRule, StopsAtTheFirstPrefixWhoseIntervalIsNarrow) {
  const std::vector<Record> all = records(200);
  const std::int64_t n = stopping_size(asking_for(0.2), all).value();
  // Slow twin: moments of every prefix.
  std::int64_t expected = 0;
  std::vector<double> zones;
  for (std::size_t i = 0; i < all.size() && expected == 0; ++i) {
    if (all[i].done) zones.push_back(all[i].measures.influence_zone);
    if (zones.size() >= 10 && *mean_half_width(moments(zones)) <= 0.2) expected = static_cast<std::int64_t>(i) + 1;
  }
  EXPECT_EQ(n, expected);
  EXPECT_GT(n, 20);
}

TEST(StopRule, DoesNotDependOnWhatElseHasFinished) {
  const auto n = stopping_size(asking_for(0.2), records(200));
  EXPECT_EQ(stopping_size(asking_for(0.2), records(*n)), n);
  EXPECT_FALSE(stopping_size(asking_for(0.2), records(*n - 1)));
  std::vector<Record> with_gap = records(200);
  with_gap.erase(with_gap.begin() + 5);
  EXPECT_FALSE(stopping_size(asking_for(0.2), with_gap));
}

TEST(StopRule, NeedsTenThatAreDone) {
  std::vector<Record> all;
  for (std::int64_t i = 0; i < 12; ++i) all.push_back(i < 2 ? failed(i, "x") : done(i, 34.0));
  EXPECT_EQ(stopping_size(asking_for(0.2), all), 12);
  all.pop_back();
  EXPECT_FALSE(stopping_size(asking_for(0.2), all));
}

TEST(StopRule, NoWishNoStop) { EXPECT_FALSE(stopping_size(plan(1000), records(200))); }

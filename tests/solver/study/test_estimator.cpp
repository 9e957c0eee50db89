#include <cmath>
#include <cstdint>
#include <map>
#include <span>

#include "statistics/sample.hpp"
#include "studies.hpp"
#include "study/estimator.hpp"

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

/// The size at which the rule stops the study of these records, if it does.
std::optional<std::int64_t> stopping_size(const Plan& plan, const std::vector<Record>& records) {
  StopRule rule(plan.study.stop_half_width);
  for (const Record& r : records) rule.add(r.index, r.influence_zone());
  return rule.size();
}

/// Half the width of the 95 % interval of the mean.
double half_width(std::span<const double> sample) {
  const Interval ci = moments(sample).mean_ci95.value();
  return 0.5 * (*ci.hi - *ci.lo);
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
    if (zones.size() >= 10 && half_width(zones) <= 0.2) expected = static_cast<std::int64_t>(i) + 1;
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

TEST(Estimator, OrdersTheRunsOfAStudy) {
  const std::vector<RunKey> order{realization(0), replicate(1), replicate(2), realization(1), realization(2)};
  for (std::int64_t rank = 0; rank < std::ssize(order); ++rank) {
    EXPECT_EQ(run_of_rank(rank, 2), order[static_cast<std::size_t>(rank)]) << rank;
  }
  EXPECT_EQ(run_of_rank(1, 0), realization(1));
}

TEST(Estimator, TooManyFailedIsAShareOfThePlannedRealizations) {
  using Decision = Estimator::Decision;
  Plan p = plan(10);
  p.study.max_failed_share = 0.2;
  Estimator estimator(p.study, 0, 10);
  estimator.add(realization(3), std::nullopt);
  estimator.add(replicate(1), std::nullopt);
  estimator.add(realization(4), std::nullopt);
  EXPECT_EQ(estimator.decision(), Decision::go_on);
  estimator.add(realization(0), std::nullopt);
  EXPECT_EQ(estimator.decision(), Decision::too_many_failed);
  EXPECT_EQ(estimator.failed(), 3);

  Estimator part(p.study, 0, 4);  // a range of its own: 1 of 4 is more than the share
  part.add(realization(7), std::nullopt);
  EXPECT_EQ(part.decision(), Decision::go_on);
  part.add(realization(2), std::nullopt);
  EXPECT_EQ(part.decision(), Decision::too_many_failed);
}

TEST(Estimator, AStudyWithNothingDoneHasFailedWhateverTheShare) {
  EXPECT_TRUE(too_many_failed(3, 0, 3, 1.0));
  EXPECT_FALSE(too_many_failed(2, 0, 3, 1.0));
  EXPECT_FALSE(too_many_failed(2, 1, 3, 1.0));
  EXPECT_FALSE(too_many_failed(0, 0, 0, 1.0));
}

TEST(Estimator, KnowsTheFarthestAndTheMean) {
  Estimator estimator(plan(10).study, 0, 10);
  EXPECT_TRUE(estimator.is_farthest(5, 1.0));
  EXPECT_FALSE(estimator.mean());
  for (const auto& [index, zone] : std::map<std::int64_t, double>{{2, 3.0}, {5, 7.0}, {6, 2.0}})
    estimator.add(realization(index), zone);
  estimator.add(replicate(1), 99.0);
  EXPECT_FALSE(estimator.is_farthest(7, 6.0));
  EXPECT_FALSE(estimator.is_farthest(7, 7.0));  // the least index of equals
  EXPECT_TRUE(estimator.is_farthest(4, 7.0));
  EXPECT_TRUE(estimator.is_farthest(7, 7.5));
  EXPECT_DOUBLE_EQ(*estimator.mean(), 4.0);
  const double sample[] = {3.0, 7.0, 2.0};
  EXPECT_NEAR(*estimator.mean_half_width(), half_width(sample), 1e-12);
}

TEST(Estimator, StopsEarlyInWhateverOrderTheRealizationsEnd) {
  Plan p = asking_for(0.2);
  const std::vector<Record> all = records(200);
  Estimator estimator(p.study, 0, p.study.realizations);
  for (std::size_t i = all.size(); i-- > 0;) {
    EXPECT_EQ(estimator.decision(), Estimator::Decision::go_on) << i;
    estimator.add(realization(all[i].index),
                  all[i].done ? std::optional(all[i].measures.influence_zone) : std::nullopt);
  }
  EXPECT_EQ(estimator.decision(), Estimator::Decision::enough);
}

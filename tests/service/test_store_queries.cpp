// What is asked of the queue: jobs, realizations, verdicts.

#include <gtest/gtest.h>

#include "store_fixture.hpp"
#include "support/measures.hpp"

namespace talus::service {
namespace {

using namespace test_store;

TEST_F(StoreTest, JobsAreListedNewestFirstByPages) {
  for (const char* id : {"1", "2", "3", "4"}) add(id, 1, 0, id == std::string("2") ? "b" : "a");
  JobFilter filter{.subject = "a", .limit = 2};
  const auto page = store->jobs(filter);
  ASSERT_EQ(page.size(), 2u);
  EXPECT_EQ(page[0].id + page[1].id, "43");
  filter.before = page[1].number;
  const auto rest = store->jobs(filter);
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_EQ(rest[0].id, "1");
  EXPECT_TRUE(store->jobs({.states = {JobState::failed}}).empty());
  EXPECT_TRUE(store->jobs({.processes = {"echo"}}).empty());
}

TEST_F(StoreTest, JobsAreListedByTheTimeOfTheirCreation) {
  for (const char* id : {"1", "2", "3"}) {
    add(id, 1);
    now += 1000;
  }
  const auto found = [&](std::optional<Milliseconds> from, std::optional<Milliseconds> to) {
    std::string ids;
    for (const Job& j : store->jobs({.created_from = from, .created_to = to})) ids += j.id;
    return ids;
  };
  EXPECT_EQ(found({}, {}), "321");
  EXPECT_EQ(found(1'001'000, {}), "32");
  EXPECT_EQ(found({}, 1'001'000), "21");
  EXPECT_EQ(found(1'001'000, 1'001'000), "2");
}

TEST_F(StoreTest, JobsAreListedByTheirDuration) {
  const Job ended = add("ended", 1);
  store->accept(*store->claim(), result(1));
  now += 3000;
  store->finish(ended.number, JobState::successful, "");
  add("running", 1);
  store->claim();
  add("accepted", 1);
  now += 5000;
  const auto found = [&](std::optional<Milliseconds> least, std::optional<Milliseconds> most) {
    std::string ids;
    for (const Job& j : store->jobs({.least_duration = least, .most_duration = most})) ids += j.id + " ";
    return ids;
  };
  EXPECT_EQ(found(0, {}), "running ended ");  // one that has not started has no duration
  EXPECT_EQ(found(3001, {}), "running ");
  EXPECT_EQ(found({}, 4999), "ended ");
  EXPECT_EQ(found(3000, 5000), "running ended ");
}

TEST_F(StoreTest, RealizationsAreFoundByTheirMeasure) {
  const Job made = add("one", 5);
  for (double zone = 10; const auto claim = store->claim(); zone += 1) store->accept(*claim, result(zone));
  const auto found = store->runs(made.number, {.least = 11.0, .below = 13.0});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].key.index, 1);
  EXPECT_EQ(store->runs(made.number, {.least = 11.0, .most = 13.0}).size(), 3u);
  EXPECT_EQ(store->runs(made.number, {.after = 2, .limit = 1})[0].key.index, 3);
}

TEST_F(StoreTest, VerdictsAreCounted) {
  add("one", 5, 1);
  const auto end_run = [&](Verdict verdict, const std::string& objections) {
    Record record = result(7.5);
    record.verdict = verdict;
    record.objections = objections;
    ASSERT_TRUE(store->accept(*store->claim(), record));
  };
  end_run(Verdict::doubtful, "left_terrain: 3 of 5");  // realization 0
  end_run(Verdict::doubtful, "replicates do not count");
  end_run(Verdict::sound, "");
  end_run(Verdict::not_assessed, "");
  ASSERT_TRUE(store->fail(*store->claim(), {.reason = reason_of_invalid("mach_number: 0.7 times")}));
  ASSERT_TRUE(store->fail(*store->claim(), {.reason = "diverged"}));
  const QualityCounts expected{.sound = 1, .doubtful = 1, .invalid = 1, .not_assessed = 1};
  EXPECT_EQ(job("one").quality, expected);
  EXPECT_EQ(store->measure_sample(job("one"), measure_table[0], {}).quality, expected);
  EXPECT_EQ(store->measure_sample(job("one"), measure_table[0], 1e-9).quality, expected);
  const std::vector<std::string> rows = table_of(*store, job("one").number);
  EXPECT_NE(rows.at(0).find(",doubtful,\"left_terrain: 3 of 5\""), std::string::npos) << rows[0];
  EXPECT_NE(rows.at(3).find(",invalid,\"mach_number: 0.7 times\""), std::string::npos) << rows[3];
  EXPECT_EQ(store->retry_failed(job("one").number), 2);
  EXPECT_EQ(job("one").quality, (QualityCounts{.sound = 1, .doubtful = 1, .not_assessed = 1}));
}

TEST_F(StoreTest, RunsOfSeveralLevelsAreDistinct) {
  const Job made = add("one", 1);
  SQLite::Database((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE)
      .exec("INSERT INTO runs (job, level, kind, idx, rank) VALUES (1, 1, 0, 0, 1)");
  store->accept(*store->claim(), result(1));
  const Claim fine = *store->claim();
  EXPECT_EQ(fine.key, (RunKey{.level = 1}));
  store->accept(fine, result(2));
  EXPECT_EQ(store->run(made.number, fine.key)->result->measures.influence_zone, 2);
  EXPECT_EQ(store->run(made.number, realization(0))->result->measures.influence_zone, 1);
  EXPECT_EQ(store->measure_sample(job("one"), measure_table[0], {}).values, std::vector<double>{1});
}

TEST_F(StoreTest, EachMeasureHasItsOwnLowerBounds) {
  add("one", 3);
  Record cut = result(31);
  cut.lower_bounds = "influence_zone_m front_mass_999_m";
  for (const Record& record : {result(20), cut, result(25)}) ASSERT_TRUE(store->accept(*store->claim(), record));
  for (const std::optional<double>& stop : {std::optional<double>(), std::optional(1e-9)}) {
    const auto censored = [&](const char* key) {
      return store->measure_sample(job("one"), *find_measure(key), stop).censored;
    };
    EXPECT_EQ(censored("influence_zone_m"), std::vector<double>{31});
    EXPECT_EQ(censored("front_mass_999_m"), std::vector<double>{3});
    EXPECT_TRUE(censored("front_mass_99_m").empty()) << "whose key is not part of another";
    EXPECT_TRUE(censored("centre_of_mass_x_m").empty());
  }
}

}  // namespace
}  // namespace talus::service

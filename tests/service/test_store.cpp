// The queue: leases, attempts, fairness, and what is left of them after a crash.

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <cmath>
#include <set>
#include <thread>

#include "queue/store.hpp"
#include "study/publish.hpp"
#include "support/measures.hpp"
#include "temporary_directory.hpp"

namespace talus::service {
namespace {

constexpr Milliseconds lease = 30'000;

struct StoreTest : testing::Test {
  test::TemporaryDirectory directory;
  Milliseconds now = 1'000'000;
  std::unique_ptr<Store> store = open();

  std::unique_ptr<Store> open() {
    return std::make_unique<Store>(
        directory / "queue.sqlite", directory / "jobs", [this] { return now; }, lease);
  }
  Job add(const std::string& id, std::int64_t realizations, std::int64_t replicates = 0,
          const std::string& subject = "a") {
    return *store->create(
        {.id = id, .process = "influence-zone", .subject = subject, .planned = realizations, .replicates = replicates});
  }
  Job job(const std::string& id) { return *store->job(id); }
  static Record result(double zone) {
    return {.done = true,
            .measures = {zone, 1, 2, 3, 4},
            .mean_phi_deg = 25,
            .captured_variance = 0.9,
            .steps = 9,
            .wall_clock = 0.5,
            .digest = "d",
            .verdict = Verdict::sound};
  }
  /// How many runs the store puts back when `held` are renewed.
  std::int64_t requeued(std::vector<Claim> held = {}) { return store->renew_leases(held).requeued; }
};

TEST_F(StoreTest, AJobIsThereAfterReopening) {
  add("one", 3, 2);
  store = open();
  const Job found = job("one");
  EXPECT_EQ(found.state, JobState::accepted);
  EXPECT_EQ(found.planned, 3);
  EXPECT_EQ(found.created, 1'000'000);
  EXPECT_FALSE(found.started);
  EXPECT_FALSE(store->job("two"));
}

TEST_F(StoreTest, RunsAreClaimedOnceEachOriginThenFloorThenTheRest) {
  const Job made = add("one", 3, 2);
  std::vector<std::string> order;
  while (const auto claim = store->claim())
    order.push_back((claim->key.is_replicate() ? "f" : "r") + std::to_string(claim->key.index));
  EXPECT_EQ(order, (std::vector<std::string>{"r0", "f1", "f2", "r1", "r2"}));
  EXPECT_EQ(job("one").state, JobState::running);
  EXPECT_TRUE(store->complete_jobs().empty());
  EXPECT_EQ(made.seed, 0);
}

TEST_F(StoreTest, ClaimsAreSharedByTwoThreads) {
  add("one", 200);
  std::mutex mutex;
  std::multiset<std::int64_t> seen;
  const auto work = [&] {
    while (const auto claim = store->claim()) {
      store->accept(*claim, result(1));
      const std::lock_guard lock(mutex);
      seen.insert(claim->key.index);
    }
  };
  std::thread a(work), b(work);
  a.join();
  b.join();
  EXPECT_EQ(seen.size(), 200u);
  EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), 200u);
  EXPECT_EQ(job("one").done, 200);
}

TEST_F(StoreTest, AResultCountsOnlyFromTheCurrentAttempt) {
  add("one", 1);
  const Claim first = *store->claim();
  now += lease + 1;
  EXPECT_EQ(requeued(), 1);
  const Claim second = *store->claim();
  EXPECT_EQ(second.attempt, first.attempt + 1);
  EXPECT_FALSE(store->is_current(first));
  EXPECT_FALSE(store->accept(first, result(1)));
  EXPECT_FALSE(store->fail(first, {.reason = "late"}));
  EXPECT_FALSE(store->give_back(first, true));
  EXPECT_EQ(job("one").done, 0);
  EXPECT_TRUE(store->accept(second, result(2)));
  EXPECT_FALSE(store->accept(second, result(3)));
  EXPECT_EQ(job("one").done, 1);
  EXPECT_EQ(store->run(second.study, second.key)->result->measures.influence_zone, 2);
}

TEST_F(StoreTest, RenewingKeepsALeaseAndTellsOfALostOne) {
  add("one", 2);
  const Claim kept = *store->claim(), lost = *store->claim();
  now += lease - 1;
  EXPECT_TRUE(store->renew(std::vector{kept}).empty());
  now += 2;
  EXPECT_EQ(requeued(), 1);
  EXPECT_EQ(store->renew(std::vector{kept, lost}), (std::vector<std::size_t>{1}));
}

TEST_F(StoreTest, AClockSetBackDoesNotHoldALeaseForEver) {
  add("one", 1);
  store->claim();
  now -= 3'600'000;
  EXPECT_EQ(requeued(), 1);
}

TEST_F(StoreTest, WhatIsHeldSurvivesAnyJumpOfTheClock) {
  add("one", 1);
  const Claim held = *store->claim();
  for (const Milliseconds jump : {3'600'000, -7'200'000, 86'400'000}) {
    now += jump;
    const Store::Renewal renewal = store->renew_leases(std::vector{held});
    EXPECT_TRUE(renewal.lost.empty());
    EXPECT_EQ(renewal.requeued, 0);
  }
}

TEST_F(StoreTest, ReopeningPutsBackEveryLeaseButNoResult) {
  add("one", 3);
  const Claim done = *store->claim();
  store->accept(done, result(1));
  store->claim();
  store = open();
  EXPECT_EQ(store->requeue_all(), 1);
  EXPECT_EQ(store->state_counts().runs[static_cast<std::size_t>(RunState::queued)], 2);
  EXPECT_EQ(store->state_counts().runs[static_cast<std::size_t>(RunState::done)], 1);
  EXPECT_EQ(store->claim()->attempt, 2);
}

TEST_F(StoreTest, OneHugeJobDoesNotStarveASmallOne) {
  add("huge", 1000);
  std::vector<Claim> running;
  for (int i = 0; i < 4; ++i) running.push_back(*store->claim());
  add("small", 3);
  std::string order;
  for (int i = 0; i < 4; ++i) {  // the huge one's runs end; the small one gets every place until it has as many
    store->accept(running.front(), result(1));
    running.erase(running.begin());
    running.push_back(*store->claim());
    order += store->job(running.back().study)->id + " ";
  }
  EXPECT_EQ(order, "small small huge huge ");
}

TEST_F(StoreTest, EqualJobsTakeTurns) {
  add("a", 100);
  add("b", 100);
  std::string order;
  for (int i = 0; i < 6; ++i) {
    const Claim claim = *store->claim();
    order += store->job(claim.study)->id;
    store->accept(claim, result(1));
  }
  EXPECT_EQ(order, "ababab");
}

TEST_F(StoreTest, CrashesAreCountedInterruptionsAreNot) {
  add("one", 1);
  store->give_back(*store->claim(), false);
  store->give_back(*store->claim(), true);
  const Claim third = *store->claim();
  EXPECT_EQ(third.attempt, 3);
  EXPECT_EQ(third.crashes, 1);
  EXPECT_TRUE(store->fail(third, {.reason = "killed", .signal = 9, .log_tail = "tail"}));
  const service::Run run = *store->run(third.study, third.key);
  EXPECT_EQ(run.failure->signal, 9);
  EXPECT_FALSE(run.failure->exit_code);
  EXPECT_EQ(run.failure->log_tail, "tail");
  EXPECT_EQ(job("one").failed, 1);
}

TEST_F(StoreTest, AJobEndsOnlyWhenNothingOfItIsLeft) {
  const Job made = add("one", 1);
  const Claim claim = *store->claim();
  EXPECT_FALSE(store->finish(made.number, JobState::successful, ""));
  store->accept(claim, result(1));
  ASSERT_EQ(store->complete_jobs().size(), 1u);
  EXPECT_TRUE(store->finish(made.number, JobState::successful, "done"));
  EXPECT_TRUE(job("one").finished);
  EXPECT_TRUE(store->complete_jobs().empty());
  EXPECT_FALSE(store->finish(made.number, JobState::failed, "again"));
}

TEST_F(StoreTest, AnOpenJobSaysWhyItWaits) {
  const Job made = add("one", 1);
  store->note_pending_reason(made.number, "waits for rain");
  EXPECT_EQ(job("one").message, "waits for rain");
  EXPECT_GT(job("one").version, made.version);
  store->accept(*store->claim(), result(1));
  store->finish(made.number, JobState::successful, "done");
  store->note_pending_reason(made.number, "waits for rain");
  EXPECT_EQ(job("one").message, "done");
}

TEST_F(StoreTest, DismissingTakesTheRunsAway) {
  const Job made = add("one", 3);
  const Claim claim = *store->claim();
  store->dismiss(made.number);
  EXPECT_FALSE(store->accept(claim, result(1)));
  EXPECT_EQ(store->renew(std::vector{claim}).size(), 1u);
  EXPECT_FALSE(store->claim());
  EXPECT_EQ(job("one").state, JobState::dismissed);
}

TEST_F(StoreTest, RetryTakesOnlyTheFailedOnes) {
  const Job made = add("one", 2);
  store->accept(*store->claim(), result(1));
  store->fail(*store->claim(), {.reason = "diverged", .exit_code = 4});
  store->finish(made.number, JobState::failed, "");
  EXPECT_EQ(store->retry_failed(made.number), 1);
  EXPECT_EQ(job("one").state, JobState::running);
  EXPECT_EQ(job("one").failed, 0);
  EXPECT_EQ(store->claim()->key.index, 1);
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, AStudyThatStopsEarlyKeepsItsReplicates) {
  const Job made = add("one", 4, 2);
  store->accept(*store->claim(), result(1));
  const Claim replicate = *store->claim(), later = *store->claim(), realization = *store->claim();
  store->drop_open_runs(made.number, false);
  EXPECT_TRUE(store->is_current(replicate));
  EXPECT_TRUE(store->is_current(later));
  EXPECT_FALSE(store->is_current(realization));
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, AnAbortedJobSaysWhyAndGoesOnWhenRetried) {
  const Job made = add("one", 3, 1);
  store->accept(*store->claim(), result(1));
  const Claim claim = *store->claim();
  store->abort(made.number, true, "refuses the case");
  EXPECT_FALSE(store->is_current(claim));
  EXPECT_EQ(job("one").state, JobState::failed);
  EXPECT_EQ(job("one").message, "refuses the case");
  EXPECT_EQ(store->retry_failed(made.number), 0);
  EXPECT_EQ(job("one").state, JobState::running);
  std::string order;
  while (const auto next = store->claim())
    order += (next->key.is_replicate() ? "f" : "r") + std::to_string(next->key.index);
  EXPECT_EQ(order, "f1r1r2");
}

TEST_F(StoreTest, TheEngineSeesEveryRecord) {
  const Job made = add("one", 3, 1);
  store->accept(*store->claim(), result(7.0));
  store->accept(*store->claim(), result(8.0));
  store->fail(*store->claim(), {.reason = "diverged"});
  std::string seen;
  store->visit_records(made.number, [&](const RunKey& key, std::optional<double> zone) {
    seen += work_name(key) + (zone ? " " + std::to_string(static_cast<int>(*zone)) : " failed") + "; ";
  });
  EXPECT_EQ(seen, "000000 7; 000001 failed; floor-1 8; ");
  const StudyInfo info = store->study(made.number);
  EXPECT_EQ(info.name, "one");
  EXPECT_EQ(info.paths.root, directory / "jobs" / "one");
  EXPECT_EQ(info.end, 3);
  EXPECT_EQ(info.spec.noise_floor_replicates, 1);
}

TEST_F(StoreTest, ExtendingLeavesWhatIsThere) {
  const Job made = add("one", 2, 1);
  while (const auto claim = store->claim()) store->accept(*claim, result(1));
  store->finish(made.number, JobState::successful, "");
  EXPECT_TRUE(store->extend(made.number, 4));
  EXPECT_EQ(job("one").planned, 4);
  EXPECT_EQ(job("one").done, 2);
  EXPECT_FALSE(job("one").finished);
  EXPECT_EQ(store->claim()->key.index, 2);
  EXPECT_EQ(store->claim()->key.index, 3);
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, ADismissedJobIsNotExtended) {
  const Job made = add("one", 1);
  store->dismiss(made.number);
  store->extend(made.number, 5);
  EXPECT_EQ(job("one").state, JobState::dismissed);
  EXPECT_EQ(job("one").planned, 1);
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, AKeyIsStoredResponseWithTheJobOrNeither) {
  const auto answer = [](const Job& j) {
    return StoredResponse{
        .subject = "a", .key = "k", .body_hash = "h", .status = 201, .location = "/" + j.id, .body = "b"};
  };
  const NewJob first{.id = "one", .process = "echo", .subject = "a"};
  NewJob second = first;
  second.id = "two";
  EXPECT_TRUE(store->create(first, answer));
  EXPECT_FALSE(store->create(second, answer));
  EXPECT_FALSE(store->job("two"));
  EXPECT_EQ(store->stored_response("a", "k")->location, "/one");
  EXPECT_FALSE(store->stored_response("b", "k"));
}

TEST_F(StoreTest, AKeyIsForgottenAfterAWeek) {
  const auto with_key = [](const char* key) {
    return [key](const Job&) { return StoredResponse{.subject = "a", .key = key, .body_hash = "h"}; };
  };
  store->create({.id = "one", .process = "echo", .subject = "a"}, with_key("old"));
  now += Milliseconds{8} * 24 * 3600 * 1000;
  store->create({.id = "two", .process = "echo", .subject = "a"}, with_key("new"));
  EXPECT_FALSE(store->stored_response("a", "old"));
  EXPECT_TRUE(store->stored_response("a", "new"));
}

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

TEST_F(StoreTest, AFullDatabaseIsToldAndNothingIsHalfWritten) {
  add("one", 1);
  SQLite::Database raw((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE);
  // As many pages as there are: the file cannot grow. The limit is of a connection, so the store gets one of its own.
  try {
    Database small(directory / "queue.sqlite");
    small.write([](SQLite::Database& db) {
      db.exec("PRAGMA max_page_count = 1");
      db.exec("CREATE TABLE x (a TEXT)");
      for (int i = 0; i < 1000; ++i) db.exec("INSERT INTO x VALUES (hex(randomblob(1000)))");
    });
    ADD_FAILURE() << "it was written";
  } catch (const StorageError& e) {
    EXPECT_TRUE(e.disk_full);
  }
  EXPECT_FALSE(raw.tableExists("x"));
  EXPECT_TRUE(store->job("one"));
}

TEST_F(StoreTest, AFileThatCannotBeWrittenIsToldAsSuch) {
  Database database(directory / "queue.sqlite");
  database.write([](SQLite::Database& db) { db.exec("PRAGMA query_only = ON"); });
  try {
    database.write([](SQLite::Database& db) { db.exec("CREATE TABLE x (a TEXT)"); });
    ADD_FAILURE() << "it was written";
  } catch (const StorageError& e) {
    EXPECT_FALSE(e.disk_full);
    EXPECT_STREQ(e.what(), "the queue cannot be written: attempt to write a readonly database");
  }
}

TEST_F(StoreTest, WhatIsCommittedIsOnTheDisk) {
  Database database(directory / "queue.sqlite");
  database.write([](SQLite::Database& db) {
    EXPECT_EQ(db.execAndGet("PRAGMA journal_mode").getString(), "wal");
    EXPECT_EQ(db.execAndGet("PRAGMA synchronous").getInt(), 2);  // FULL
    EXPECT_EQ(db.execAndGet("PRAGMA foreign_keys").getInt(), 1);
  });
}

/// The rows of realizations.csv of a job, without the header.
std::vector<std::string> table_of(Store& store, std::int64_t job) {
  std::vector<std::string> rows;
  store.records(job, RunKind::realization)([&](const Record& record) { rows.push_back(csv_line(record)); });
  return rows;
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

TEST_F(StoreTest, ADatabaseFromBeforeAMeasureGetsItsColumn) {
  add("one", 1);
  const Claim claim = *store->claim();
  ASSERT_TRUE(store->accept(claim, result(7.5)));
  store.reset();
  SQLite::Database((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE)
      .exec("DROP INDEX runs_measures; ALTER TABLE runs DROP COLUMN front_mass_999_m");
  store = open();
  const auto run = store->run(claim.study, claim.key);
  ASSERT_TRUE(run && run->result);
  EXPECT_EQ(run->result->measures.influence_zone, 7.5);
  EXPECT_TRUE(std::isnan(run->result->measures.front_mass_999));
  EXPECT_TRUE(store->measure_sample(job("one"), *find_measure("front_mass_999_m"), {}).values.empty());
  EXPECT_EQ(store->measure_sample(job("one"), *find_measure("influence_zone_m"), {}).values, std::vector<double>{7.5});
  EXPECT_EQ(table_of(*store, claim.study), std::vector<std::string>{"0,done,7.5,1,2,,4,25,0.9,9,0.5,d,,sound,,,0\n"});
}

/// The tables of version 2, before runs had a level, with one job: realization 0 and replicate 1 are done, realization
/// 1 has failed, 2 is leased and 3 waits.
constexpr const char* version_2 = R"sql(
CREATE TABLE jobs (
  number INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, process TEXT NOT NULL, subject TEXT NOT NULL,
  title TEXT NOT NULL, inputs TEXT NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('accepted', 'running', 'successful', 'failed', 'dismissed')),
  message TEXT NOT NULL DEFAULT '', seed INTEGER NOT NULL, planned INTEGER NOT NULL CHECK (planned >= 0),
  floor INTEGER NOT NULL CHECK (floor >= 0), max_failed_share REAL NOT NULL, may_stop_early INTEGER NOT NULL,
  case_hash TEXT NOT NULL, particles REAL NOT NULL, steps REAL NOT NULL, created INTEGER NOT NULL,
  updated INTEGER NOT NULL, started INTEGER, finished INTEGER, done INTEGER NOT NULL DEFAULT 0,
  failed INTEGER NOT NULL DEFAULT 0, floor_made INTEGER NOT NULL DEFAULT 0, version INTEGER NOT NULL DEFAULT 1,
  served INTEGER NOT NULL DEFAULT 0) STRICT;
CREATE INDEX jobs_by_state ON jobs (state, number);
CREATE TABLE runs (
  job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE, floor INTEGER NOT NULL CHECK (floor IN (0, 1)),
  idx INTEGER NOT NULL CHECK (idx >= 0), rank INTEGER NOT NULL,
  state TEXT NOT NULL DEFAULT 'queued' CHECK (state IN ('queued', 'leased', 'done', 'failed')),
  attempt INTEGER NOT NULL DEFAULT 0, crashes INTEGER NOT NULL DEFAULT 0, lease_until INTEGER NOT NULL DEFAULT 0,
  influence_zone_m REAL, front_connected_m REAL, front_mass_99_m REAL, front_mass_999_m REAL, centre_of_mass_x_m REAL,
  mean_friction_angle_deg REAL, steps INTEGER, wall_clock_s REAL, digest TEXT, reason TEXT, exit_code INTEGER,
  signal INTEGER, log_tail TEXT, captured_variance REAL, PRIMARY KEY (job, floor, idx)) STRICT, WITHOUT ROWID;
CREATE INDEX runs_queued ON runs (job, rank) WHERE state = 'queued';
CREATE INDEX runs_leased ON runs (job) WHERE state = 'leased';
CREATE INDEX runs_measures ON runs (job, floor, idx, state, influence_zone_m, front_connected_m, front_mass_99_m,
                                    front_mass_999_m, centre_of_mass_x_m) WHERE state = 'done';
CREATE TABLE remembered (
  subject TEXT NOT NULL, key TEXT NOT NULL, body_hash TEXT NOT NULL, status INTEGER NOT NULL, location TEXT NOT NULL,
  body TEXT NOT NULL, created INTEGER NOT NULL, PRIMARY KEY (subject, key)) STRICT, WITHOUT ROWID;
PRAGMA user_version = 2;
INSERT INTO jobs (id, process, subject, title, inputs, state, seed, planned, floor, max_failed_share, may_stop_early,
                  case_hash, particles, steps, created, updated, started, done, failed, floor_made)
  VALUES ('old', 'influence-zone', 'a', 't', '{}', 'running', 7, 4, 1, 0.5, 0, 'h', 10, 20, 1, 2, 3, 1, 1, 1);
INSERT INTO runs (job, floor, idx, rank, state, attempt, influence_zone_m, front_connected_m, front_mass_99_m,
                  front_mass_999_m, centre_of_mass_x_m, mean_friction_angle_deg, captured_variance, steps, wall_clock_s,
                  digest)
  VALUES (1, 0, 0, 0, 'done', 1, 7.5, 1, 2, 3, 4, 25, NULL, 9, 0.5, 'd'),
         (1, 1, 1, 1, 'done', 1, 7.25, 1, 2, 3, 4, 25, 0.9, 9, 0.5, 'e');
INSERT INTO runs (job, floor, idx, rank, state, attempt, crashes, reason, exit_code, log_tail)
  VALUES (1, 0, 1, 2, 'failed', 2, 1, 'diverged', 4, 'tail');
INSERT INTO runs (job, floor, idx, rank, state, attempt, lease_until)
  VALUES (1, 0, 2, 3, 'leased', 1, 9000000), (1, 0, 3, 4, 'queued', 0, 0);
INSERT INTO remembered VALUES ('a', 'k', 'h', 201, '/old', 'b', 1);
)sql";

TEST_F(StoreTest, ADatabaseFromBeforeLevelsIsMigrated) {
  store.reset();
  for (const char* suffix : {"", "-wal", "-shm"})
    std::filesystem::remove(directory / (std::string("queue.sqlite") + suffix));
  SQLite::Database((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec(version_2);
  store = open();
  const Job old = job("old");
  EXPECT_EQ(old.replicates, 1);
  EXPECT_EQ(old.replicates_ended, 1);
  EXPECT_EQ(old.done, 1);
  EXPECT_EQ(store->stored_response("a", "k")->location, "/old");
  EXPECT_EQ(store->measure_sample(old, measure_table[0], {}).values, std::vector<double>{7.5});
  EXPECT_EQ(store->measure_sample(old, measure_table[0], {}).noise, (std::vector<double>{7.5, 7.25}));
  EXPECT_EQ(table_of(*store, old.number), (std::vector<std::string>{"0,done,7.5,1,2,3,4,25,0.9,9,0.5,d,,,,,\n",
                                                                    "1,failed,,,,,,,,,,,\"diverged\",,,,\n"}));
  EXPECT_EQ(old.quality, (QualityCounts{.not_assessed = 1}));
  const service::Run failed = *store->run(old.number, realization(1));
  EXPECT_EQ(failed.key.level, 0);
  EXPECT_EQ(failed.failure->exit_code, 4);
  EXPECT_EQ(store->claim()->key, realization(3));
  EXPECT_EQ(store->requeue_all(), 2);
  const Claim again = *store->claim();
  EXPECT_EQ(again.key, realization(2));
  EXPECT_EQ(again.attempt, 2);
  SQLite::Database raw((directory / "queue.sqlite").string());
  EXPECT_FALSE(SQLite::Statement(raw, "PRAGMA foreign_key_check(runs)").executeStep());
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

TEST_F(StoreTest, TheIndexCoversTheHistogram) {
  SQLite::Database raw((directory / "queue.sqlite").string());
  SQLite::Statement plan(raw,
                         "EXPLAIN QUERY PLAN SELECT influence_zone_m FROM runs INDEXED BY runs_measures "
                         "WHERE job = 1 AND level = 0 AND state = 'done' AND influence_zone_m IS NOT NULL "
                         "AND kind = 0 ORDER BY idx");
  ASSERT_TRUE(plan.executeStep());
  EXPECT_EQ(plan.getColumn("detail").getString(),
            "SEARCH runs USING COVERING INDEX runs_measures (job=? AND level=? AND kind=?)");
  EXPECT_FALSE(plan.executeStep());  // no sort
}

TEST_F(StoreTest, ANewerDatabaseIsRefused) {
  SQLite::Database((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_THROW(open(), StorageError);
}

}  // namespace
}  // namespace talus::service

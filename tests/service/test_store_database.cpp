// The database under the queue: full, unwritable, durable, of an earlier and of a later version.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <filesystem>

#include "store_fixture.hpp"
#include "support/measures.hpp"

namespace talus::service {
namespace {

using namespace test_store;

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
  EXPECT_EQ(table_of(*store, claim.study),
            std::vector<std::string>{"0,done,7.5,1,2,,4,25,0.9,9,0.5,d,,sound,,,5,0,0.6\n"});
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
  EXPECT_EQ(table_of(*store, old.number), (std::vector<std::string>{"0,done,7.5,1,2,3,4,25,0.9,9,0.5,d,,,,,,,\n",
                                                                    "1,failed,,,,,,,,,,,\"diverged\",,,,,,\n"}));
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

struct EchoTest : StoreTest {
  Job add_echo(const std::string& id, const std::string& values, const std::string& subject = "a") {
    return *store->create({.id = id, .process = "echo", .subject = subject, .inputs = R"({"pause":0.5})"}, {}, {},
                          values);
  }
  std::uintmax_t file_bytes() {
    SQLite::Database(directory / "queue.sqlite", SQLite::OPEN_READWRITE).exec("PRAGMA wal_checkpoint(TRUNCATE)");
    return std::filesystem::file_size(directory / "queue.sqlite");
  }
};

TEST_F(EchoTest, TheValuesOfEchoJobsAreKeptApartUntilTheyAreDismissed) {
  const Job one = add_echo("one", R"({"s":"x"})");
  add_echo("two", R"({"s":"yy"})", "b");
  EXPECT_EQ(store->jobs({}).at(1).inputs, R"({"pause":0.5})");
  EXPECT_EQ(store->echo_inputs(one.number), R"({"s":"x"})");
  EXPECT_EQ(store->echo_bytes({}), 9 + 10);
  EXPECT_EQ(store->echo_bytes("b"), 10);
  store->dismiss(one.number);
  EXPECT_EQ(store->echo_inputs(one.number), "{}");
  EXPECT_EQ(store->echo_bytes("a"), 0);
}

TEST_F(EchoTest, DismissedJobsFreeTheirSpace) {
  const std::string values(1 << 20, 'x');
  for (int i = 0; i < 8; ++i) add_echo(std::to_string(i), values);
  EXPECT_FALSE(store->shrink(100));
  EXPECT_GT(file_bytes(), 8 * values.size());
  for (const Job& each : store->jobs({})) store->dismiss(each.number);
  EXPECT_TRUE(store->shrink(100));
  EXPECT_FALSE(store->shrink(1'000'000));
  EXPECT_LT(file_bytes(), values.size());
}

TEST_F(EchoTest, ADatabaseWithTheValuesInTheRowsOfTheJobsIsMigrated) {
  for (const char* id : {"kept", "dismissed"}) add_echo(id, "{}");
  store->dismiss(job("dismissed").number);
  add("study", 1);
  store.reset();
  {
    SQLite::Database raw((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE);
    raw.exec(
        "PRAGMA journal_mode = DELETE; PRAGMA auto_vacuum = NONE; VACUUM; DROP TABLE echo_inputs;"
        "ALTER TABLE runs DROP COLUMN targets;"
        "PRAGMA user_version = 6");
    raw.exec(R"(UPDATE jobs SET inputs = '{"outputs":["s"],"pause":0.5,"inputs":{"s":"\u00e9","x":[1e300,0.10]}}'
                WHERE process = 'echo')");
    EXPECT_EQ(raw.execAndGet("PRAGMA auto_vacuum").getInt(), 0);
  }
  store = open();
  EXPECT_EQ(job("kept").inputs, R"({"outputs":["s"],"pause":0.5})");
  EXPECT_EQ(store->echo_inputs(job("kept").number), R"({"s":"\u00e9","x":[1e300,0.10]})");
  EXPECT_EQ(job("dismissed").inputs, R"({"outputs":["s"],"pause":0.5})");
  EXPECT_EQ(store->echo_inputs(job("dismissed").number), "{}");
  EXPECT_EQ(store->echo_bytes({}), 31);
  EXPECT_EQ(job("study").inputs, "{}");
  SQLite::Database raw((directory / "queue.sqlite").string());
  EXPECT_EQ(raw.execAndGet("PRAGMA auto_vacuum").getInt(), 2);
}

TEST_F(StoreTest, KeepsWhatARunDidToItsTargets) {
  add("one", 2);
  Record made = result(7.5);
  made.targets = {{.of = {"road", TargetKind::stretch}, .open = true, .peak_depth = 1.0 / 3.0},
                  {.of = {"house", TargetKind::structure}, .arrives = true, .arrival = 2.5}};
  TargetOutcome& house = made.targets[1];
  for (const TargetNumber& number : target_numbers)
    if (number.structures_only) house.*number.member = 0.1;
  const Claim claim = *store->claim();
  ASSERT_TRUE(store->accept(claim, made));
  store = open();
  const auto run = store->run(claim.study, claim.key);
  ASSERT_TRUE(run && run->result);
  EXPECT_FALSE(run->damaged);
  EXPECT_EQ(csv_line(*run->result), csv_line(made));
  ASSERT_EQ(run->result->targets.size(), 2u);
  EXPECT_EQ(run->result->targets[0].of, made.targets[0].of);
  store.reset();
  SQLite::Database((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE runs SET targets = replace(targets, '2.5', '3.5')");
  store = open();
  const auto spoilt = store->run(claim.study, claim.key);
  EXPECT_TRUE(!spoilt || spoilt->damaged) << "the checksum does not cover the targets";
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

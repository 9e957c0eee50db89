// Single flipped bits in the file of the queue: each is found and made good, refused, or changes nothing that is read.

#include <fstream>
#include <iterator>
#include <random>

#include "store_fixture.hpp"
#include "support/json.hpp"

namespace talus::service {
namespace {

using namespace test_store;
namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A queue with a job of 40 realizations and two replicates, some of them done, one failed; as a file.
struct Damage : StoreTest {
  std::string whole;

  Record result_of(std::int64_t index) {
    Record made = result(20.0 + 0.125 * static_cast<double>(index));
    made.index = index;
    made.verdict = index % 3 == 0 ? Verdict::doubtful : Verdict::sound;
    made.objections = index % 3 == 0 ? "creeping: it creeps" : "";
    return made;
  }

  void SetUp() override {
    add("job", 40, 2);
    for (int i = 0; i < 30; ++i) {
      const Claim claim = *store->claim();
      if (claim.key == realization(7))
        store->fail(claim, {.reason = "diverged"});
      else
        store->accept(claim, result_of(claim.key.index));
    }
    store->requeue_all();
    store.reset();
    whole = content(directory / "queue.sqlite");
  }

  void write(const std::string& text) {
    for (const char* suffix : {"-wal", "-shm"}) fs::remove(directory / (std::string("queue.sqlite") + suffix));
    std::ofstream(directory / "queue.sqlite", std::ios::binary) << text;
  }

  /// Opens the queue as talusd does at start, and compares all that it says of the runs with what was recorded.
  void check() {
    store = open();
    store->repair_rows();
    const std::optional<Job> job = store->job("job");
    ASSERT_TRUE(job);
    std::int64_t done = 0, doubtful = 0;
    std::vector<double> zones;
    store->records(job->number, RunKind::realization)([&](const Record& record) {
      if (!record.done) return;
      EXPECT_EQ(csv_line(record), csv_line(result_of(record.index)));
      zones.push_back(record.measures.influence_zone);
      ++done;
      doubtful += record.verdict == Verdict::doubtful ? 1 : 0;
    });
    EXPECT_EQ(store->measure_sample(*job, measure_table[0], {}).values, zones);
    EXPECT_EQ(job->done, done);
    EXPECT_EQ(job->quality.doubtful, doubtful);
  }
};

TEST_F(Damage, NoFlippedBitChangesANumberInSilence) {
  check();
  store.reset();
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    std::string damaged = whole;
    const std::size_t bit = random() % (8 * whole.size());
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    write(damaged);
    SCOPED_TRACE("bit " + std::to_string(bit));
    try {
      check();
    } catch (const std::exception&) {
      ++refused;
    }
    store.reset();
  }
  std::cout << refused << " of 400 damaged queues refused, the others repaired or unharmed\n";
  EXPECT_LT(refused, 400);
}

TEST_F(Damage, ADamagedRowIsQueuedAgainAndTheCountsFollow) {
  write(whole);
  SQLite::Database raw((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE);
  raw.exec("UPDATE runs SET influence_zone_m = 94.29 WHERE kind = 0 AND idx = 3");
  raw.exec("UPDATE runs SET idx = 61 WHERE kind = 0 AND idx = 4");
  raw.exec("UPDATE jobs SET done = 99, message = 'kept'");
  store = open();
  EXPECT_EQ(store->repair_rows(), (std::vector<std::string>{"job job: the record of realization 3",
                                                            "job job: the record of realization 61"}));
  EXPECT_EQ(store->repair_rows(), std::vector<std::string>{});
  check();
  EXPECT_EQ(job("job").done, 25);
  EXPECT_EQ(store->run(job("job").number, realization(3))->state, RunState::queued);
  EXPECT_EQ(store->run(job("job").number, realization(4))->state, RunState::queued);
  EXPECT_FALSE(store->run(job("job").number, realization(61)));
  SQLite::Database((directory / "queue.sqlite").string(), SQLite::OPEN_READWRITE).exec("UPDATE jobs SET sound = 1");
  EXPECT_EQ(store->repair_rows(), std::vector<std::string>{"job job: its counts"});
  check();
}

TEST_F(Damage, WhatSubmissionFixedIsRestored) {
  write(whole);
  store = open();
  NewJob right = job("job");
  EXPECT_FALSE(store->restore(job("job"), right));
  right.seed = 8;
  right.subject = "b";
  EXPECT_TRUE(store->restore(job("job"), right));
  EXPECT_EQ(job("job").seed, 8);
  EXPECT_EQ(job("job").subject, "b");
  EXPECT_EQ(job("job").planned, 40);
}

}  // namespace
}  // namespace talus::service

// A study of a million realizations in the database: its histogram and its tables.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <numeric>

#include "queue/store.hpp"
#include "study/estimator.hpp"
#include "study/publish.hpp"
#include "temporary_directory.hpp"

namespace talus::service {
namespace {

constexpr std::int64_t million = 1'000'000;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A job whose realization i came to x = 30 + (i mod 1000) / 100 m, but for every 1000th, which failed.
Job million_job(Store& store, const std::filesystem::path& database) {
  const Job job = *store.create({.id = "m", .process = "influence-zone", .subject = "a", .planned = 1});
  SQLite::Database db(database.string(), SQLite::OPEN_READWRITE);
  SQLite::Transaction transaction(db);
  db.exec("DELETE FROM runs");
  std::string values;
  for (const Measure& measure : measure_table) values += std::string(", ") + measure.key;
  SQLite::Statement insert(
      db,
      "WITH RECURSIVE i(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM i WHERE k < ?1 - 1) "
      "INSERT INTO runs (job, kind, idx, rank, state, attempt, digest, reason, steps, wall_clock_s, "
      "mean_friction_angle_deg, captured_variance" +
          values +
          ") SELECT 1, 0, k, k, "
          "iif(k % 1000 = 999, 'failed', 'done'), 1, printf('%016x', k), 'diverged', 1000, 1.5, 25 + (k % 7) * 0.1, "
          "0.9" +
          [] {
            std::string all;
            for (std::size_t k = 0; k < measure_table.size(); ++k) all += ", 30 + (k % 1000) * 0.01";
            return all;
          }() +
          " FROM i");
  insert.bind(1, million);
  insert.exec();
  db.exec("UPDATE jobs SET planned = 1000000, done = 999000, failed = 1000, state = 'running'");
  transaction.commit();
  db.exec("PRAGMA wal_checkpoint(TRUNCATE)");  // as it is in a service that has recorded them one by one
  return *store.job(job.id);
}

TEST(MillionRealizations, HistogramAndTablesComeFromTheRecords) {
  const test::TemporaryDirectory directory;
  Store store(
      directory / "queue.sqlite", directory / "jobs", [] { return Milliseconds{1'000'000}; }, 30'000);
  const Job job = million_job(store, directory / "queue.sqlite");
  Plan plan{.title = "A slope", .of = {"0123456789abcdef"}, .version = "0", .seed = 1, .study = {}};
  plan.study.realizations = million;
  plan.study.noise_floor_replicates = 0;

  auto begin = std::chrono::steady_clock::now();
  const Json answer = distribution(plan, measure_table[0], store.measure_sample(job, measure_table[0], {}), {});
  std::cout << "histogram of a million realizations: " << seconds_since(begin) << " s\n";
  EXPECT_EQ(answer.at("n"), million - 1000);
  EXPECT_EQ(answer.at("failed"), 1000);
  EXPECT_EQ(answer.at("complete"), true);
  EXPECT_EQ(answer.at("min"), 30.0);
  EXPECT_NEAR(answer.at("max").get<double>(), 39.98, 1e-12);
  EXPECT_NEAR(answer.at("mean").get<double>(), 30.0 + 0.01 * 998.0 / 2.0, 1e-9);
  const auto counts = answer.at("histogram").at("counts").get<std::vector<std::int64_t>>();
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}), million - 1000);

  begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(store.repair_rows().empty());
  std::cout << "the rows of a million records are checked: " << seconds_since(begin) << " s\n";
  begin = std::chrono::steady_clock::now();
  Database(directory / "queue.sqlite");
  std::cout << "their pages and their index are checked: " << seconds_since(begin) << " s\n";

  begin = std::chrono::steady_clock::now();
  Estimator estimator(plan.study, 0, million);
  store.visit_records(job.number, [&](const RunKey& key, std::optional<double> zone) { estimator.add(key, zone); });
  std::cout << "the engine opens a study of a million records: " << seconds_since(begin) << " s\n";
  EXPECT_EQ(estimator.done(), million - 1000);
  EXPECT_EQ(estimator.failed(), 1000);

  begin = std::chrono::steady_clock::now();
  const StudySummary summary =
      publish(StudyPaths{directory.path()}, plan, store.records(job.number, RunKind::realization),
              store.records(job.number, RunKind::replicate));
  std::cout << "tables and study.json of a million realizations: " << seconds_since(begin) << " s\n";
  EXPECT_EQ(summary.done(), million - 1000);
  const std::vector<Record> back = read_csv(directory / "realizations.csv", "index");
  ASSERT_EQ(back.size(), static_cast<std::size_t>(million));
  EXPECT_EQ(back[1234].measures.influence_zone, 30 + 234 * 0.01);
  EXPECT_EQ(back[999].reason, "diverged");
}

}  // namespace
}  // namespace talus::service

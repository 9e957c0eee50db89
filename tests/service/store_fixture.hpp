#pragma once
// A queue in a directory of its own, with a clock that the test sets.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "queue/store.hpp"
#include "study/publish.hpp"
#include "temporary_directory.hpp"

namespace talus::service::test_store {

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
            .measures = {zone, 1, 2, 3, 4, 5},
            .mean_phi_deg = 25,
            .captured_variance = 0.9,
            .front_thickness = 0.6,
            .steps = 9,
            .wall_clock = 0.5,
            .digest = "d",
            .verdict = Verdict::sound};
  }
  /// How many runs the store puts back when `held` are renewed.
  std::int64_t requeued(std::vector<Claim> held = {}) { return store->renew_leases(held).requeued; }
};

/// The rows of realizations.csv of a job, without the header.
inline std::vector<std::string> table_of(Store& store, std::int64_t job) {
  std::vector<std::string> rows;
  store.records(job, RunKind::realization)([&](const Record& record) { rows.push_back(csv_line(record)); });
  return rows;
}

}  // namespace talus::service::test_store

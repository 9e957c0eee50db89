// The runs of a job as the records of a study: what statistics and tables are made of.

#include <cmath>

#include "queue/rows.hpp"
#include "queue/store.hpp"

namespace talus::service {
namespace {

using SQLite::Statement;

std::vector<double> column(SQLite::Database& db, const std::string& sql, std::int64_t job) {
  Statement query(db, sql);
  query.bind(1, job);
  std::vector<double> values;
  while (query.executeStep())
    if (!query.isColumnNull(0)) values.push_back(query.getColumn(0).getDouble());
  return values;
}

}  // namespace

void Store::for_each_record(std::int64_t job, bool floor, const std::function<void(const Record&)>& take) {
  db_.read([&](SQLite::Database& db) {
    // Runs of before the column say nothing of the captured variance; it is the same for all runs of a case.
    Statement known(db, "SELECT MAX(captured_variance) FROM runs WHERE job = ? AND state = 'done'");
    known.bind(1, job);
    known.executeStep();
    const double captured_variance = known.getColumn(0).getDouble();
    Statement query(db, "SELECT " + run_columns +
                            " FROM runs WHERE job = ? AND floor = ? AND state IN ('done', 'failed') ORDER BY idx");
    query.bind(1, job);
    query.bind(2, floor ? 1 : 0);
    while (query.executeStep()) {
      const Run run = run_of(query);
      Record record = run.result.value_or(Record{.index = run.key.index});
      if (run.failure) record.reason = run.failure->reason;
      if (std::isnan(record.captured_variance)) record.captured_variance = captured_variance;
      take(record);
    }
  });
}

MeasureSample Store::measure_sample(const Job& job, const Measure& measure,
                                    const std::optional<double>& stop_half_width) {
  return db_.read([&](SQLite::Database& db) {
    const std::string key = measure.key;
    MeasureSample sample;
    // The index holds the measures of all runs that are done, in order, and nothing else: a narrow scan.
    const std::string done = "SELECT " + key +
                             " FROM runs INDEXED BY runs_measures WHERE job = ? AND state = 'done' AND " + key +
                             " IS NOT NULL";
    sample.noise = column(db, done + " AND floor = 1 ORDER BY idx", job.number);
    if (job.floor_made > 0) {
      const std::vector<double> origin = column(db, done + " AND floor = 0 AND idx = 0", job.number);
      sample.noise.insert(sample.noise.begin(), origin.begin(), origin.end());
    }
    sample.failed = job.failed;
    sample.complete = job.done + job.failed == job.planned;
    if (!stop_half_width) {
      sample.values = column(db, done + " AND floor = 0 ORDER BY idx", job.number);
      return sample;
    }
    StopRule rule(stop_half_width);
    sample.failed = 0;
    Statement query(db, "SELECT idx, state = 'done', influence_zone_m, " + key +
                            " FROM runs WHERE job = ? AND floor = 0 AND state IN ('done', 'failed') ORDER BY idx");
    query.bind(1, job.number);
    while (!rule.size() && query.executeStep()) {
      const bool good = query.getColumn(1).getInt() != 0;
      rule.add(query.getColumn(0).getInt64(), good ? std::optional(query.getColumn(2).getDouble()) : std::nullopt);
      if (!good)
        ++sample.failed;
      else if (!query.getColumn(3).isNull())
        sample.values.push_back(query.getColumn(3).getDouble());
    }
    sample.complete = sample.complete || rule.size();
    return sample;
  });
}

}  // namespace talus::service

// The runs of a job as the records of a study, for statistics and tables.

#include <cmath>

#include "queue/sql.hpp"
#include "queue/store.hpp"

namespace talus::service {
namespace {

std::vector<double> column(SQLite::Database& db, const std::string& sql, std::int64_t job) {
  std::vector<double> values;
  for (SQLite::Statement query = statement(db, sql, job); query.executeStep();)
    values.push_back(query.getColumn(0).getDouble());
  return values;
}

}  // namespace

RecordSource Store::records(std::int64_t job, RunKind kind) {
  return [this, job, kind](const RecordSink& take) {
    db_.read([&](SQLite::Database& db) {
      // Old databases do not have the captured variance of every run; it is the same for all runs of a case.
      const std::vector<double> known =
          column(db, "SELECT captured_variance FROM runs WHERE job = ? AND captured_variance IS NOT NULL LIMIT 1", job);
      const double captured_variance = known.empty() ? 0.0 : known.front();
      visit_runs(
          db,
          [&](const Run& run) {
            Record record = run.result.value_or(Record{.index = run.key.index});
            if (run.failure) record.reason = run.failure->reason;
            if (std::isnan(record.captured_variance)) record.captured_variance = captured_variance;
            take(record);
          },
          "job = ? AND level = 0 AND kind = ? AND state IN ('done', 'failed') ORDER BY idx", job, kind);
    });
  };
}

MeasureSample Store::measure_sample(const Job& job, const Measure& measure,
                                    const std::optional<double>& stop_half_width) {
  return db_.read([&](SQLite::Database& db) {
    const std::string key = measure.key;
    MeasureSample sample;
    sample.failed = job.failed;
    sample.complete = job.done + job.failed == job.planned;
    // The index holds the measures of all runs that are done, in order, and nothing else: a narrow scan.
    const std::string done = "SELECT " + key +
                             " FROM runs INDEXED BY runs_measures WHERE job = ? AND level = 0 AND state = 'done' AND " +
                             key + " IS NOT NULL";
    if (job.replicates_ended > 0) sample.noise = column(db, done + " AND kind = 0 AND idx = 0", job.number);
    const std::vector<double> replicates = column(db, done + " AND kind = 1 ORDER BY idx", job.number);
    sample.noise.insert(sample.noise.end(), replicates.begin(), replicates.end());
    if (!stop_half_width) {
      sample.values = column(db, done + " AND kind = 0 ORDER BY idx", job.number);
      return sample;
    }
    StopRule rule(stop_half_width);
    sample.failed = 0;
    SQLite::Statement query = statement(db,
                                        "SELECT idx, iif(state = 'done', influence_zone_m, NULL), " + key +
                                            " FROM runs WHERE job = ? AND level = 0 AND kind = 0 AND state IN "
                                            "('done', 'failed') ORDER BY idx",
                                        job.number);
    while (!rule.size() && query.executeStep()) {
      std::int64_t index = 0;
      std::optional<double> influence_zone, value;
      Row(query) >> index >> influence_zone >> value;
      rule.add(index, influence_zone);
      if (!influence_zone)
        ++sample.failed;
      else if (value)
        sample.values.push_back(*value);
    }
    sample.complete = sample.complete || rule.size();
    return sample;
  });
}

}  // namespace talus::service

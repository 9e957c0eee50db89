#include "queue/rows.hpp"

#include <limits>

namespace talus::service {
namespace {

std::optional<std::int64_t> integer(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional<std::int64_t>(column.getInt64());
}
std::optional<int> small(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional<int>(column.getInt());
}

}  // namespace

Job job_of(SQLite::Statement& row) {
  Job job;
  int i = 0;
  job.number = row.getColumn(i++).getInt64();
  job.id = row.getColumn(i++).getString();
  job.process = row.getColumn(i++).getString();
  job.subject = row.getColumn(i++).getString();
  job.title = row.getColumn(i++).getString();
  job.inputs = row.getColumn(i++).getString();
  job.state = job_state(row.getColumn(i++).getString()).value();
  job.message = row.getColumn(i++).getString();
  job.seed = row.getColumn(i++).getInt64();
  job.planned = row.getColumn(i++).getInt64();
  job.floor = row.getColumn(i++).getInt64();
  job.max_failed_share = row.getColumn(i++).getDouble();
  job.may_stop_early = row.getColumn(i++).getInt() != 0;
  job.case_hash = row.getColumn(i++).getString();
  job.particles = row.getColumn(i++).getDouble();
  job.steps = row.getColumn(i++).getDouble();
  job.created = row.getColumn(i++).getInt64();
  job.updated = row.getColumn(i++).getInt64();
  job.started = integer(row.getColumn(i++));
  job.finished = integer(row.getColumn(i++));
  job.done = row.getColumn(i++).getInt64();
  job.failed = row.getColumn(i++).getInt64();
  job.floor_made = row.getColumn(i++).getInt64();
  job.version = row.getColumn(i++).getInt64();
  return job;
}

RunKind kind_of(const SQLite::Column& floor) { return floor.getInt() != 0 ? RunKind::replicate : RunKind::realization; }

Run run_of(SQLite::Statement& row) {
  Run run;
  int i = 0;
  run.job = row.getColumn(i++).getInt64();
  run.key.kind = kind_of(row.getColumn(i++));
  run.key.index = row.getColumn(i++).getInt64();
  run.state = run_state(row.getColumn(i++).getString()).value();
  run.attempt = row.getColumn(i++).getInt64();
  run.crashes = row.getColumn(i++).getInt64();
  if (run.state == RunState::done) {
    Record result{.index = run.key.index, .done = true};
    visit_numbers(result, [&](const char*, const char*, auto& number) {
      const SQLite::Column value = row.getColumn(i++);
      if constexpr (std::is_same_v<decltype(number), std::int64_t&>)
        number = value.getInt64();
      else  // a run from before the measure existed has no value of it
        number = value.isNull() ? std::numeric_limits<double>::quiet_NaN() : value.getDouble();
    });
    result.digest = row.getColumn(i++).getString();
    run.result = std::move(result);
  } else if (run.state == RunState::failed) {
    i += static_cast<int>(measure_table.size() + covariate_table.size()) + 1;
    Failure failure;
    failure.reason = row.getColumn(i++).getString();
    failure.exit_code = small(row.getColumn(i++));
    failure.signal = small(row.getColumn(i++));
    failure.log_tail = row.getColumn(i++).getString();
    run.failure = std::move(failure);
  }
  return run;
}

std::vector<Job> all_jobs(SQLite::Statement& query) {
  std::vector<Job> jobs;
  while (query.executeStep()) jobs.push_back(job_of(query));
  return jobs;
}

void touch(SQLite::Database& db, std::int64_t job, Milliseconds now) {
  SQLite::Statement update(db, "UPDATE jobs SET updated = ?, version = version + 1 WHERE number = ?");
  update.bind(1, now);
  update.bind(2, job);
  update.exec();
}

}  // namespace talus::service

#pragma once
// Statements with their parameters, and rows as structs.

#include <SQLiteCpp/SQLiteCpp.h>

#include <limits>

#include "queue/records.hpp"
#include "study/directory_store.hpp"

namespace talus::service {

/// Binds the parameters of a statement in order. An empty optional is NULL; a RunKey fills three parameters (level,
/// kind, index), a Claim five (job, those three, attempt).
class Binder {
 public:
  explicit Binder(SQLite::Statement& statement) : statement_(statement) {}

  template <class T>
  Binder& operator<<(const T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, RunKind>)
      statement_.bind(next_++, static_cast<int>(value));
    else if constexpr (std::is_enum_v<T>)
      statement_.bind(next_++, word(value));
    else
      statement_.bind(next_++, value);
    return *this;
  }
  template <class T>
  Binder& operator<<(const std::optional<T>& value) {
    if (value) return *this << *value;
    statement_.bind(next_++);
    return *this;
  }
  Binder& operator<<(const RunKey& key) { return *this << key.level << key.kind << key.index; }
  Binder& operator<<(const Claim& claim) { return *this << claim.study << claim.key << claim.attempt; }

 private:
  SQLite::Statement& statement_;
  int next_ = 1;
};

template <class... Values>
SQLite::Statement statement(SQLite::Database& db, const std::string& sql, const Values&... values) {
  SQLite::Statement made(db, sql);
  (Binder(made) << ... << values);
  return made;
}

/// @return how many rows it changed
template <class... Values>
int execute(SQLite::Database& db, const std::string& sql, const Values&... values) {
  return statement(db, sql, values...).exec();
}

/// Reads the columns of a row in order. NULL is an empty optional, the NaN of a double, or the zero of another type.
class Row {
 public:
  explicit Row(SQLite::Statement& row) : row_(row) {}

  template <class T>
  Row& operator>>(T& value) {
    const SQLite::Column column = row_.getColumn(next_++);
    if constexpr (std::is_same_v<T, JobState>)
      value = job_state(column.getString()).value();
    else if constexpr (std::is_same_v<T, RunState>)
      value = run_state(column.getString()).value();
    else if constexpr (std::is_same_v<T, Verdict>)
      value = verdict_of(column.getString()).value_or(Verdict::not_assessed);
    else if constexpr (std::is_same_v<T, std::string>)
      value = column.getString();
    else if constexpr (std::is_same_v<T, double>)
      value = column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
    else
      value = static_cast<T>(column.getInt64());
    return *this;
  }
  template <class T>
  Row& operator>>(std::optional<T>& value) {
    if (row_.isColumnNull(next_)) {
      ++next_;
      value.reset();
      return *this;
    }
    return *this >> value.emplace();
  }
  Row& operator>>(RunKey& key) { return *this >> key.level >> key.kind >> key.index; }

 private:
  SQLite::Statement& row_;
  int next_ = 0;
};

/// The jobs for which `condition` holds; it may end in ORDER BY and LIMIT.
template <class... Values>
std::vector<Job> select_jobs(SQLite::Database& db, const std::string& condition, const Values&... values) {
  std::vector<Job> jobs;
  SQLite::Statement query = statement(
      db,
      "SELECT number, id, process, subject, title, inputs, state, message, seed, planned, replicates, "
      "max_failed_share, may_stop_early, case_hash, particles, steps, created, updated, started, finished, done, "
      "failed, replicates_ended, sound, doubtful, invalid, version FROM jobs WHERE " +
          condition,
      values...);
  while (query.executeStep()) {
    Job& job = jobs.emplace_back();
    Row(query) >> job.number >> job.id >> job.process >> job.subject >> job.title >> job.inputs >> job.state >>
        job.message >> job.seed >> job.planned >> job.replicates >> job.max_failed_share >> job.may_stop_early >>
        job.case_hash >> job.particles >> job.steps >> job.created >> job.updated >> job.started >> job.finished >>
        job.done >> job.failed >> job.replicates_ended >> job.quality.sound >> job.quality.doubtful >>
        job.quality.invalid >> job.version;
    job.quality.not_assessed = job.done - job.quality.sound - job.quality.doubtful;
  }
  return jobs;
}

/// Gives each run for which `condition` holds to `take`; one is held at a time.
template <class Take, class... Values>
void visit_runs(SQLite::Database& db, Take take, const std::string& condition, const Values&... values) {
  std::string numbers;
  const Record any;
  visit_numbers(any, [&](const char* key, const char*, auto) { numbers += key + std::string(", "); });
  SQLite::Statement query = statement(
      db,
      "SELECT job, level, kind, idx, state, attempt, crashes, " + numbers +
          "digest, verdict, verdict_reasons, lower_bounds, targets, reason, exit_code, signal, log_tail, checksum "
          "FROM runs WHERE " +
          condition,
      values...);
  while (query.executeStep()) {
    Run run;
    Record result{.done = true};
    Failure failure;
    std::optional<std::string> checksum, targets;
    Row row(query);
    row >> run.job >> run.key >> run.state >> run.attempt >> run.crashes;
    result.index = run.key.index;
    visit_numbers(result, [&](const char*, const char*, auto& number) { row >> number; });
    row >> result.digest >> result.verdict >> result.objections >> result.lower_bounds >> targets >> failure.reason >>
        failure.exit_code >> failure.signal >> failure.log_tail >> checksum;
    const bool readable = read_targets_text(targets, result);
    run.damaged =
        run.state == RunState::done && checksum && (!readable || *checksum != checksum_of(run.job, run.key, result));
    if (run.state == RunState::done) run.result = std::move(result);
    if (run.state == RunState::failed) run.failure = std::move(failure);
    take(run);
  }
}

/// Changes a job for which `condition` holds, and counts the change in its version. ?1 is the job, ?2 the time;
/// `values` follow from ?3 on.
/// @return whether the condition held
template <class... Values>
bool change_job(SQLite::Database& db, std::int64_t job, Milliseconds now, const std::string& changes,
                const std::string& condition, const Values&... values) {
  return execute(
             db,
             "UPDATE jobs SET updated = ?2, version = version + 1, " + changes + " WHERE number = ?1 AND " + condition,
             job, now, values...) == 1;
}

/// Records runs that wait as ended, within a transaction; keys that the job does not have are ignored.
void record_ended_runs(SQLite::Database& db, std::int64_t job, RunKind kind, const Records& records, Milliseconds now);

inline constexpr const char* job_is_open = "state IN ('accepted', 'running')";
/// Holds for a job none of whose runs waits or is under way. Two terms, since each has its partial index.
inline constexpr const char* no_open_runs =
    "NOT EXISTS (SELECT 1 FROM runs WHERE job = number AND state = 'queued') AND "
    "NOT EXISTS (SELECT 1 FROM runs WHERE job = number AND state = 'leased')";

/// The counts of a job from its runs.
inline constexpr const char* recounted =
    "done = (SELECT COUNT(*) FROM runs WHERE job = ?1 AND kind = 0 AND state = 'done'), "
    "sound = (SELECT COUNT(*) FROM runs WHERE job = ?1 AND kind = 0 AND state = 'done' AND verdict = 'sound'), "
    "doubtful = (SELECT COUNT(*) FROM runs WHERE job = ?1 AND kind = 0 AND state = 'done' AND verdict = 'doubtful'), "
    "replicates_ended = (SELECT COUNT(*) FROM runs WHERE job = ?1 AND kind = 1 AND state IN ('done', 'failed'))";

/// Changes that open a job that has ended again.
inline constexpr const char* reopened = "state = 'running', finished = NULL, message = ''";

std::optional<Job> one_job(SQLite::Database& db, std::int64_t number);
/// Queues the runs of a job that it does not have yet, in the order of their ranks.
void insert_runs(SQLite::Database& db, std::int64_t job, std::int64_t replicates, std::int64_t realizations);

}  // namespace talus::service

// The jobs' half of the store.

#include "queue/rows.hpp"
#include "queue/store.hpp"

namespace talus::service {
namespace {

using SQLite::Statement;

/// Queues the runs first <= rank < end of a job that it does not have yet.
void insert_runs(SQLite::Database& db, std::int64_t job, std::int64_t replicates, std::int64_t first,
                 std::int64_t end) {
  Statement insert(db, "INSERT INTO runs (job, floor, idx, rank) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING");
  for (std::int64_t rank = first; rank < end; ++rank) {
    const RunKey key = run_of_rank(rank, replicates);
    insert.bind(1, job);
    insert.bind(2, key.is_replicate() ? 1 : 0);
    insert.bind(3, key.index);
    insert.bind(4, rank);
    insert.exec();
    insert.reset();
  }
}

constexpr Milliseconds key_lifetime = Milliseconds{7} * 24 * 3600 * 1000;

/// Forgets old keys, and keeps this one. @return false where it is there already
bool remember(SQLite::Database& db, const Remembered& answer, Milliseconds now) {
  Statement forget(db, "DELETE FROM remembered WHERE created < ?");
  forget.bind(1, now - key_lifetime);
  forget.exec();
  Statement insert(db,
                   "INSERT INTO remembered (subject, key, body_hash, status, location, body, created) "
                   "VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING");
  insert.bind(1, answer.subject);
  insert.bind(2, answer.key);
  insert.bind(3, answer.body_hash);
  insert.bind(4, answer.status);
  insert.bind(5, answer.location);
  insert.bind(6, answer.body);
  insert.bind(7, now);
  return insert.exec() == 1;
}

std::optional<Job> one_job(SQLite::Database& db, std::int64_t number) {
  Statement query(db, std::string("SELECT ") + job_columns + " FROM jobs WHERE number = ?");
  query.bind(1, number);
  return query.executeStep() ? std::optional(job_of(query)) : std::nullopt;
}

/// Thrown inside a transaction so that it is rolled back.
struct KeyTaken {};

template <class Write>
bool unless_key_taken(Write write) try {
  write();
  return true;
} catch (const KeyTaken&) {
  return false;
}

void reopen(SQLite::Database& db, std::int64_t job, Milliseconds now) {
  Statement update(db,
                   "UPDATE jobs SET state = 'running', finished = NULL, message = '', updated = ?, "
                   "version = version + 1 WHERE number = ?");
  update.bind(1, now);
  update.bind(2, job);
  update.exec();
}

std::string placeholders(std::size_t n) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += i ? ", ?" : "?";
  return text;
}

std::set<std::string> ids(Database& database, const std::string& condition) {
  return database.read([&](SQLite::Database& db) {
    std::set<std::string> all;
    for (Statement query(db, "SELECT id FROM jobs WHERE " + condition); query.executeStep();)
      all.insert(query.getColumn(0).getString());
    return all;
  });
}

}  // namespace

std::optional<Job> Store::create(const NewJob& job, const Answer& answer) {
  std::optional<Job> made;
  const bool fresh = unless_key_taken([&] {
    db_.write([&](SQLite::Database& db) {
      const Milliseconds now = clock_();
      Statement insert(db,
                       "INSERT INTO jobs (id, process, subject, title, inputs, state, seed, planned, floor, "
                       "max_failed_share, may_stop_early, case_hash, particles, steps, created, updated) "
                       "VALUES (?, ?, ?, ?, ?, 'accepted', ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
      int i = 1;
      for (const std::string* text : {&job.id, &job.process, &job.subject, &job.title, &job.inputs})
        insert.bind(i++, *text);
      for (const std::int64_t number : {job.seed, job.planned, job.floor}) insert.bind(i++, number);
      insert.bind(i++, job.max_failed_share);
      insert.bind(i++, job.may_stop_early ? 1 : 0);
      insert.bind(i++, job.case_hash);
      insert.bind(i++, job.particles);
      insert.bind(i++, job.steps);
      insert.bind(i++, now);
      insert.bind(i++, now);
      insert.exec();
      const std::int64_t number = db.getLastInsertRowid();
      if (job.planned > 0) insert_runs(db, number, job.floor, 0, job.floor + job.planned);
      made = one_job(db, number);
      if (answer && !remember(db, answer(*made), now)) throw KeyTaken{};
    });
  });
  return fresh ? made : std::nullopt;
}

std::optional<Job> Store::job(const std::string& id) {
  return db_.read([&](SQLite::Database& db) -> std::optional<Job> {
    Statement query(db, std::string("SELECT ") + job_columns + " FROM jobs WHERE id = ?");
    query.bind(1, id);
    return query.executeStep() ? std::optional(job_of(query)) : std::nullopt;
  });
}

std::optional<Job> Store::job(std::int64_t number) {
  return db_.read([&](SQLite::Database& db) { return one_job(db, number); });
}

std::vector<Job> Store::jobs(const JobFilter& filter) {
  std::string where = "1 = 1";
  if (filter.subject) where += " AND subject = ?";
  if (filter.before) where += " AND number < ?";
  if (filter.created_from) where += " AND created >= ?";
  if (filter.created_to) where += " AND created <= ?";
  const std::string duration = "COALESCE(finished, " + std::to_string(clock_()) + ") - started";  // NULL: not started
  if (filter.least_duration) where += " AND " + duration + " >= ?";
  if (filter.most_duration) where += " AND " + duration + " <= ?";
  if (!filter.states.empty()) where += " AND state IN (" + placeholders(filter.states.size()) + ")";
  if (!filter.processes.empty()) where += " AND process IN (" + placeholders(filter.processes.size()) + ")";
  return db_.read([&](SQLite::Database& db) {
    Statement query(
        db, std::string("SELECT ") + job_columns + " FROM jobs WHERE " + where + " ORDER BY number DESC LIMIT ?");
    int i = 1;
    if (filter.subject) query.bind(i++, *filter.subject);
    for (const auto& bound :
         {filter.before, filter.created_from, filter.created_to, filter.least_duration, filter.most_duration})
      if (bound) query.bind(i++, *bound);
    for (const JobState state : filter.states) query.bind(i++, word(state));
    for (const std::string& process : filter.processes) query.bind(i++, process);
    query.bind(i, filter.limit);
    return all_jobs(query);
  });
}

std::int64_t Store::open_jobs(const std::optional<std::string>& subject) {
  return db_.read([&](SQLite::Database& db) {
    Statement query(db, std::string("SELECT COUNT(*) FROM jobs WHERE state IN ('accepted', 'running')") +
                            (subject ? " AND subject = ?" : ""));
    if (subject) query.bind(1, *subject);
    query.executeStep();
    return query.getColumn(0).getInt64();
  });
}

std::set<std::string> Store::known_ids() { return ids(db_, "state != 'dismissed'"); }

std::set<std::string> Store::dismissed_ids() { return ids(db_, "state = 'dismissed'"); }

Census Store::census() {
  return db_.read([&](SQLite::Database& db) {
    Census census;
    for (Statement query(db, "SELECT state, COUNT(*) FROM jobs GROUP BY state"); query.executeStep();)
      census.jobs[static_cast<std::size_t>(*job_state(query.getColumn(0).getString()))] = query.getColumn(1).getInt64();
    for (Statement query(db, "SELECT state, COUNT(*) FROM runs GROUP BY state"); query.executeStep();)
      census.runs[static_cast<std::size_t>(*run_state(query.getColumn(0).getString()))] = query.getColumn(1).getInt64();
    return census;
  });
}

void Store::note_waits(std::int64_t job, const std::string& why) {
  db_.write([&](SQLite::Database& db) {
    Statement update(db,
                     "UPDATE jobs SET message = ?1, updated = ?2, version = version + 1 "
                     "WHERE number = ?3 AND state IN ('accepted', 'running')");
    update.bind(1, why);
    update.bind(2, clock_());
    update.bind(3, job);
    update.exec();
  });
}

bool Store::finish(std::int64_t job, JobState state, const std::string& message) {
  return db_.write([&](SQLite::Database& db) {
    Statement update(db,
                     "UPDATE jobs SET state = ?1, message = ?3, finished = ?2, updated = ?2, version = version + 1 "
                     "WHERE number = ?4 AND state IN ('accepted', 'running') AND NOT EXISTS "
                     "(SELECT 1 FROM runs WHERE job = number AND runs.state = 'queued') AND NOT EXISTS "
                     "(SELECT 1 FROM runs WHERE job = number AND runs.state = 'leased')");
    update.bind(1, word(state));
    update.bind(2, clock_());
    update.bind(3, message);
    update.bind(4, job);
    return update.exec() == 1;
  });
}

void Store::dismiss(std::int64_t job) {
  db_.write([&](SQLite::Database& db) {
    const Milliseconds now = clock_();
    Statement update(db,
                     "UPDATE jobs SET state = 'dismissed', message = 'dismissed', finished = COALESCE(finished, ?1), "
                     "updated = ?1, version = version + 1 WHERE number = ?2 AND state != 'dismissed'");
    update.bind(1, now);
    update.bind(2, job);
    update.exec();
    Statement forget(db, "DELETE FROM runs WHERE job = ?");
    forget.bind(1, job);
    forget.exec();
  });
}

std::int64_t Store::retry_failed(std::int64_t job, const Answer& answer) {
  return db_.write([&](SQLite::Database& db) {
    const Milliseconds now = clock_();
    Statement update(db,
                     "UPDATE runs SET state = 'queued', crashes = 0, reason = NULL, exit_code = NULL, signal = NULL, "
                     "log_tail = NULL WHERE job = ? AND state = 'failed'");
    update.bind(1, job);
    const std::int64_t changed = update.exec();
    const Job old = *one_job(db, job);
    // A study that ended because too many had failed, or that was aborted, dropped what it had not run yet.
    if (old.state == JobState::failed) insert_runs(db, job, old.floor, 0, old.floor + old.planned);
    if (changed > 0 || old.state == JobState::failed) {
      Statement counts(
          db,
          "UPDATE jobs SET failed = 0, floor_made = (SELECT COUNT(*) FROM runs WHERE job = ?1 AND floor = 1 "
          "AND state = 'done') WHERE number = ?1");
      counts.bind(1, job);
      counts.exec();
      reopen(db, job, now);
    }
    if (answer) remember(db, answer(*one_job(db, job)), now);
    return changed;
  });
}

bool Store::extend(std::int64_t job, std::int64_t planned, const Answer& answer) {
  return unless_key_taken([&] {
    db_.write([&](SQLite::Database& db) {
      const Milliseconds now = clock_();
      const Job old = *one_job(db, job);
      if (planned <= old.planned || old.state == JobState::dismissed) return;
      insert_runs(db, job, old.floor, 0, old.floor + planned);  // also what an ended study dropped
      Statement update(db, "UPDATE jobs SET planned = ? WHERE number = ?");
      update.bind(1, planned);
      update.bind(2, job);
      update.exec();
      reopen(db, job, now);
      if (answer && !remember(db, answer(*one_job(db, job)), now)) throw KeyTaken{};
    });
  });
}

std::optional<Remembered> Store::remembered(const std::string& subject, const std::string& key) {
  return db_.read([&](SQLite::Database& db) -> std::optional<Remembered> {
    Statement query(db, "SELECT body_hash, status, location, body FROM remembered WHERE subject = ? AND key = ?");
    query.bind(1, subject);
    query.bind(2, key);
    if (!query.executeStep()) return std::nullopt;
    return Remembered{.subject = subject,
                      .key = key,
                      .body_hash = query.getColumn(0).getString(),
                      .status = query.getColumn(1).getInt(),
                      .location = query.getColumn(2).getString(),
                      .body = query.getColumn(3).getString()};
  });
}

}  // namespace talus::service

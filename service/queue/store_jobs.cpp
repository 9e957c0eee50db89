// The jobs of the store.

#include "base/json.hpp"
#include "queue/sql.hpp"
#include "queue/store.hpp"

namespace talus::service {
namespace {

constexpr std::int64_t pages_worth_shrinking = 1000;  ///< fewer are left for the next jobs
constexpr Milliseconds key_lifetime = Milliseconds{7} * 24 * 3600 * 1000;

/// Deletes old responses and stores this one. @return false where there is one for its key already
bool store_response(SQLite::Database& db, const StoredResponse& response, Milliseconds now) {
  execute(db, "DELETE FROM stored_responses WHERE created < ?", now - key_lifetime);
  return execute(db,
                 "INSERT INTO stored_responses (subject, key, body_hash, status, location, body, created) "
                 "VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING",
                 response.subject, response.key, response.body_hash, response.status, response.location, response.body,
                 now) == 1;
}

/// Inserts a job and queues its runs.
Job insert_job(SQLite::Database& db, const NewJob& job, Milliseconds created, Milliseconds now) {
  execute(db,
          "INSERT INTO jobs (id, process, subject, title, inputs, state, seed, planned, replicates, "
          "max_failed_share, may_stop_early, case_hash, particles, steps, created, updated) "
          "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
          job.id, job.process, job.subject, job.title, job.inputs, JobState::accepted, job.seed, job.planned,
          job.replicates, job.max_failed_share, job.may_stop_early, job.case_hash, job.particles, job.steps, created,
          now);
  const Job made = *one_job(db, db.getLastInsertRowid());
  if (job.planned > 0) insert_runs(db, made.number, job.replicates, job.planned);
  return made;
}

/// Thrown inside a transaction so that it is rolled back.
struct KeyTaken {};

}  // namespace

std::optional<Job> one_job(SQLite::Database& db, std::int64_t number) {
  const std::vector<Job> found = select_jobs(db, "number = ?", number);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

void insert_runs(SQLite::Database& db, std::int64_t job, std::int64_t replicates, std::int64_t realizations) {
  SQLite::Statement insert(
      db, "INSERT INTO runs (job, level, kind, idx, rank) VALUES (?, ?, ?, ?, ?) ON CONFLICT DO NOTHING");
  for (std::int64_t rank = 0; rank < replicates + realizations; ++rank) {
    Binder(insert) << job << run_of_rank(rank, replicates) << rank;
    insert.exec();
    insert.reset();
  }
}

std::optional<Job> Store::create(const NewJob& job, const Response& response,
                                 const std::optional<Milliseconds>& created,
                                 const std::optional<std::string>& echo_inputs) try {
  return db_.write([&](SQLite::Database& db) {
    const Milliseconds now = clock_();
    std::optional<Job> made = insert_job(db, job, created.value_or(now), now);
    if (echo_inputs)
      execute(db, "INSERT INTO echo_inputs (job, bytes, inputs) VALUES (?, ?, ?)", made->number,
              static_cast<std::int64_t>(echo_inputs->size()), *echo_inputs);
    if (response && !store_response(db, response(*made), now)) throw KeyTaken{};
    return made;
  });
} catch (const KeyTaken&) {
  return std::nullopt;
}

Job Store::recreate(const NewJob& job, Milliseconds created, const Records& runs, const Records& replicates) {
  return db_.write([&](SQLite::Database& db) {
    const Milliseconds now = clock_();
    const Job made = insert_job(db, job, created, now);
    change_job(db, made.number, now, "state = 'running', started = ?2", "TRUE");
    record_ended_runs(db, made.number, RunKind::realization, runs, now);
    record_ended_runs(db, made.number, RunKind::replicate, replicates, now);
    return *one_job(db, made.number);
  });
}

void Store::visit_studies(const std::function<void(const Job&)>& visit) {
  std::vector<std::int64_t> numbers;
  db_.read([&](SQLite::Database& db) {
    SQLite::Statement query(db, "SELECT number FROM jobs WHERE planned > 0 AND state != 'dismissed' ORDER BY number");
    while (query.executeStep()) numbers.push_back(query.getColumn(0).getInt64());
  });
  for (const std::int64_t number : numbers)
    if (const std::optional<Job> study = job(number)) visit(*study);
}

std::optional<Job> Store::job(const std::string& id) {
  const std::vector<Job> found = db_.read([&](SQLite::Database& db) { return select_jobs(db, "id = ?", id); });
  return found.empty() ? std::nullopt : std::optional(found.front());
}

std::optional<Job> Store::job(std::int64_t number) {
  return db_.read([&](SQLite::Database& db) { return one_job(db, number); });
}

std::vector<Job> Store::jobs(const JobFilter& filter) {
  Json states = Json::array();
  for (const JobState state : filter.states) states.push_back(word(state));
  return db_.read([&](SQLite::Database& db) {
    // The duration is NULL for a job that has not started; every comparison with it fails.
    return select_jobs(db,
                       "(?1 IS NULL OR subject = ?1) AND (?2 IS NULL OR number < ?2) "
                       "AND (?3 IS NULL OR created >= ?3) AND (?4 IS NULL OR created <= ?4) "
                       "AND (?5 IS NULL OR COALESCE(finished, ?10) - started >= ?5) "
                       "AND (?6 IS NULL OR COALESCE(finished, ?10) - started <= ?6) "
                       "AND (?7 = '[]' OR state IN (SELECT value FROM json_each(?7))) "
                       "AND (?8 = '[]' OR process IN (SELECT value FROM json_each(?8))) "
                       "ORDER BY number DESC LIMIT ?9",
                       filter.subject, filter.before, filter.created_from, filter.created_to, filter.least_duration,
                       filter.most_duration, states.dump(), dump(filter.processes), filter.limit, clock_());
  });
}

std::int64_t Store::open_jobs(const std::optional<std::string>& subject) {
  return db_.read(
      [&](SQLite::Database& db) {
        SQLite::Statement query = statement(
            db, std::string("SELECT COUNT(*) FROM jobs WHERE (?1 IS NULL OR subject = ?1) AND ") + job_is_open,
            subject);
        query.executeStep();
        return query.getColumn(0).getInt64();
      },
      Database::For::operation);
}

std::set<std::string> Store::job_ids(const std::optional<JobState>& state) {
  return db_.read([&](SQLite::Database& db) {
    std::set<std::string> ids;
    SQLite::Statement query = statement(db, "SELECT id FROM jobs WHERE ?1 IS NULL OR state = ?1", state);
    while (query.executeStep()) ids.insert(query.getColumn(0).getString());
    return ids;
  });
}

StateCounts Store::state_counts() {
  return db_.read(
      [&](SQLite::Database& db) {
        StateCounts counts;
        const auto read = [&](const char* sql, auto state, auto& counts_of_state) {
          SQLite::Statement query(db, sql);
          while (query.executeStep()) {
            std::int64_t count = 0;
            Row(query) >> state >> count;
            counts_of_state[static_cast<std::size_t>(state)] = count;
          }
        };
        read("SELECT state, COUNT(*) FROM jobs GROUP BY state", JobState{}, counts.jobs);
        read("SELECT state, COUNT(*) FROM runs GROUP BY state", RunState{}, counts.runs);
        return counts;
      },
      Database::For::operation);
}

void Store::note_pending_reason(std::int64_t job, const std::string& why) {
  db_.write([&](SQLite::Database& db) { change_job(db, job, clock_(), "message = ?3", job_is_open, why); });
}

bool Store::start(std::int64_t job) {
  return db_.write([&](SQLite::Database& db) {
    return change_job(db, job, clock_(), "state = 'running', started = ?2", "state = 'accepted'");
  });
}

bool Store::finish(std::int64_t job, JobState state, const std::string& message) {
  return db_.write([&](SQLite::Database& db) {
    return change_job(db, job, clock_(), "state = ?3, message = ?4, finished = ?2",
                      std::string(job_is_open) + " AND " + no_open_runs, state, message);
  });
}

void Store::dismiss(std::int64_t job) {
  db_.write([&](SQLite::Database& db) {
    change_job(db, job, clock_(), "state = 'dismissed', message = 'dismissed', finished = COALESCE(finished, ?2)",
               "state != 'dismissed'");
    execute(db, "DELETE FROM runs WHERE job = ?", job);
    execute(db, "DELETE FROM echo_inputs WHERE job = ?", job);
  });
}

std::string Store::echo_inputs(std::int64_t job) {
  return db_.read([&](SQLite::Database& db) -> std::string {
    SQLite::Statement query = statement(db, "SELECT inputs FROM echo_inputs WHERE job = ?", job);
    return query.executeStep() ? query.getColumn(0).getString() : "{}";
  });
}

std::int64_t Store::echo_bytes(const std::optional<std::string>& subject) {
  return db_.read([&](SQLite::Database& db) {
    SQLite::Statement query = statement(
        db, "SELECT SUM(bytes) FROM echo_inputs JOIN jobs ON job = number WHERE ?1 IS NULL OR subject = ?1", subject);
    query.executeStep();
    return query.getColumn(0).getInt64();
  });
}

bool Store::shrink(std::int64_t most) {
  const auto unused = [](SQLite::Database& db) { return db.execAndGet("PRAGMA freelist_count").getInt64(); };
  if (db_.read(unused) <= pages_worth_shrinking) return false;
  return db_.write([&](SQLite::Database& db) {
    db.exec("PRAGMA incremental_vacuum(" + std::to_string(most) + ")");
    return unused(db) > pages_worth_shrinking;
  });
}

void Store::requeue_lost(std::int64_t job, std::span<const RunKey> lost) {
  if (lost.empty()) return;
  db_.write([&](SQLite::Database& db) {
    for (const RunKey& key : lost)
      execute(db,
              "UPDATE runs SET state = 'queued', crashes = 0 "
              "WHERE job = ? AND level = ? AND kind = ? AND idx = ? AND state = 'done'",
              job, key);
    change_job(db, job, clock_(), std::string(reopened) + ", " + recounted, "state != 'dismissed'");
  });
}

std::int64_t Store::retry_failed(std::int64_t job, const Response& response) {
  return db_.write([&](SQLite::Database& db) -> std::int64_t {
    const Milliseconds now = clock_();
    const int changed = execute(db,
                                "UPDATE runs SET state = 'queued', crashes = 0, reason = NULL, exit_code = NULL, "
                                "signal = NULL, log_tail = NULL WHERE job = ? AND state = 'failed'",
                                job);
    const Job old = *one_job(db, job);
    // A study that ended because too many had failed, or that was aborted, dropped its open runs.
    if (old.state == JobState::failed) insert_runs(db, job, old.replicates, old.planned);
    if (changed > 0 || old.state == JobState::failed)
      change_job(db, job, now,
                 std::string(reopened) +
                     ", failed = 0, invalid = 0, replicates_ended = (SELECT COUNT(*) FROM runs "
                     "WHERE job = ?1 AND kind = 1 AND state = 'done')",
                 "TRUE");
    if (response) store_response(db, response(*one_job(db, job)), now);
    return changed;
  });
}

bool Store::extend(std::int64_t job, std::int64_t planned, const Response& response) try {
  db_.write([&](SQLite::Database& db) {
    const Milliseconds now = clock_();
    const Job old = *one_job(db, job);
    if (planned <= old.planned || old.state == JobState::dismissed) return;
    insert_runs(db, job, old.replicates, planned);  // also those that an ended study dropped
    change_job(db, job, now, std::string(reopened) + ", planned = ?3", "TRUE", planned);
    if (response && !store_response(db, response(*one_job(db, job)), now)) throw KeyTaken{};
  });
  return true;
} catch (const KeyTaken&) {
  return false;
}

std::optional<StoredResponse> Store::stored_response(const std::string& subject, const std::string& key) {
  return db_.read([&](SQLite::Database& db) -> std::optional<StoredResponse> {
    StoredResponse found{.subject = subject, .key = key, .body_hash = {}};
    SQLite::Statement query =
        statement(db, "SELECT body_hash, status, location, body FROM stored_responses WHERE subject = ? AND key = ?",
                  subject, key);
    if (!query.executeStep()) return std::nullopt;
    Row(query) >> found.body_hash >> found.status >> found.location >> found.body;
    return found;
  });
}

}  // namespace talus::service

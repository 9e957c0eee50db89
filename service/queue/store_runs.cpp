// The runs' half of the store: leases and how they end.

#include "queue/rows.hpp"
#include "queue/store.hpp"

namespace talus::service {
namespace {

using SQLite::Statement;

/// Whose turn it is: see Store::claim.
constexpr const char* next_job =
    "SELECT number FROM jobs AS j WHERE state IN ('accepted', 'running') "
    "AND EXISTS (SELECT 1 FROM runs WHERE job = j.number AND state = 'queued') "
    "ORDER BY (SELECT COUNT(*) FROM runs WHERE job = j.number AND state = 'leased'), served, number LIMIT 1";

/// Adds the key and the attempt to "... WHERE": the fence that a late answer cannot pass.
constexpr const char* current = " WHERE job = ? AND floor = ? AND idx = ? AND attempt = ? AND state = 'leased'";

void bind_claim(Statement& statement, int first, const Claim& claim) {
  statement.bind(first, claim.study);
  statement.bind(first + 1, claim.key.is_replicate() ? 1 : 0);
  statement.bind(first + 2, claim.key.index);
  statement.bind(first + 3, claim.attempt);
}

void count(SQLite::Database& db, const Claim& claim, bool done, Milliseconds now) {
  const char* column = claim.key.is_replicate() ? "floor_made" : done ? "done" : "failed";
  Statement update(db, std::string("UPDATE jobs SET ") + column + " = " + column +
                           " + 1, updated = ?, version = version + 1 WHERE number = ?");
  update.bind(1, now);
  update.bind(2, claim.study);
  update.exec();
}

void started(SQLite::Database& db, std::int64_t job, Milliseconds now) {
  Statement update(db,
                   "UPDATE jobs SET state = 'running', started = ?1, updated = ?1, version = version + 1 "
                   "WHERE number = ?2 AND state = 'accepted'");
  update.bind(1, now);
  update.bind(2, job);
  update.exec();
}

}  // namespace

std::optional<Claim> Store::claim() {
  const bool any = db_.read([](SQLite::Database& db) { return Statement(db, next_job).executeStep(); });
  if (!any) return std::nullopt;  // without bothering the writer
  return db_.write([&](SQLite::Database& db) -> std::optional<Claim> {
    const Milliseconds now = clock_();
    Claim claim;
    {
      Statement query(db, next_job);
      if (!query.executeStep()) return std::nullopt;
      claim.study = query.getColumn(0).getInt64();
    }
    {
      Statement query(db,
                      "SELECT floor, idx, attempt, crashes FROM runs WHERE job = ? AND state = 'queued' "
                      "ORDER BY rank LIMIT 1");
      query.bind(1, claim.study);
      query.executeStep();
      claim.key.kind = kind_of(query.getColumn(0));
      claim.key.index = query.getColumn(1).getInt64();
      claim.attempt = query.getColumn(2).getInt64() + 1;
      claim.crashes = query.getColumn(3).getInt();
    }
    Statement take(db,
                   "UPDATE runs SET state = 'leased', attempt = ?, lease_until = ? "
                   "WHERE job = ? AND floor = ? AND idx = ?");
    take.bind(1, claim.attempt);
    take.bind(2, now + lease_);
    take.bind(3, claim.study);
    take.bind(4, claim.key.is_replicate() ? 1 : 0);
    take.bind(5, claim.key.index);
    take.exec();
    Statement serve(db, "UPDATE jobs SET served = (SELECT MAX(served) + 1 FROM jobs) WHERE number = ?");
    serve.bind(1, claim.study);
    serve.exec();
    started(db, claim.study, now);
    return claim;
  });
}

Store::Renewal Store::renew_leases(std::span<const Claim> held) {
  return db_.write([&](SQLite::Database& db) {
    Renewal renewal;
    const Milliseconds now = clock_();
    Statement renew(db, std::string("UPDATE runs SET lease_until = ?") + current);
    for (std::size_t i = 0; i < held.size(); ++i) {
      renew.bind(1, now + lease_);
      bind_claim(renew, 2, held[i]);
      if (renew.exec() != 1) renewal.lost.push_back(i);
      renew.reset();
    }
    Statement expire(db,
                     "UPDATE runs SET state = 'queued' WHERE state = 'leased' "
                     "AND (lease_until < ? OR lease_until > ?)");
    expire.bind(1, now);
    expire.bind(2, now + 2 * lease_);
    renewal.requeued = expire.exec();
    return renewal;
  });
}

bool Store::is_current(const Claim& claim) {
  return db_.read([&](SQLite::Database& db) {
    Statement query(db, std::string("SELECT 1 FROM runs") + current);
    bind_claim(query, 1, claim);
    return query.executeStep();
  });
}

bool Store::accept(const Claim& claim, const Record& result) {
  return db_.write([&](SQLite::Database& db) {
    std::string set;
    visit_numbers(result, [&](const char* key, const char*, auto) { set += key + std::string(" = ?, "); });
    Statement update(db, "UPDATE runs SET state = 'done', " + set + "digest = ?" + current);
    int i = 1;
    visit_numbers(result, [&](const char*, const char*, auto value) { update.bind(i++, value); });
    update.bind(i++, result.digest);
    bind_claim(update, i, claim);
    if (update.exec() != 1) return false;
    count(db, claim, true, clock_());
    return true;
  });
}

bool Store::fail(const Claim& claim, const Failure& failure) {
  return db_.write([&](SQLite::Database& db) {
    Statement update(db, std::string("UPDATE runs SET state = 'failed', crashes = crashes + 1, reason = ?, "
                                     "exit_code = ?, signal = ?, log_tail = ?") +
                             current);
    update.bind(1, failure.reason);
    failure.exit_code ? update.bind(2, *failure.exit_code) : update.bind(2);
    failure.signal ? update.bind(3, *failure.signal) : update.bind(3);
    update.bind(4, failure.log_tail);
    bind_claim(update, 5, claim);
    if (update.exec() != 1) return false;
    count(db, claim, false, clock_());
    return true;
  });
}

bool Store::give_back(const Claim& claim, bool crashed) {
  return db_.write([&](SQLite::Database& db) {
    Statement update(db, std::string("UPDATE runs SET state = 'queued', crashes = crashes + ?") + current);
    update.bind(1, crashed ? 1 : 0);
    bind_claim(update, 2, claim);
    return update.exec() == 1;
  });
}

std::int64_t Store::requeue_all() {
  return db_.write([&](SQLite::Database& db) {
    const std::int64_t runs = db.exec("UPDATE runs SET state = 'queued' WHERE state = 'leased'");
    db.exec("UPDATE jobs SET message = '' WHERE state IN ('accepted', 'running')");  // what they waited for then
    return runs;
  });
}

StudyInfo Store::study(StudyNumber number) {
  const Job job = this->job(number).value();
  StudyInfo info{.name = job.id,
                 .paths = {jobs_ / job.id},
                 .identity = {.seed = static_cast<std::uint64_t>(job.seed), .case_hash = job.case_hash},
                 .spec = {},
                 .first = 0,
                 .end = job.planned};
  info.spec.realizations = job.planned;
  info.spec.noise_floor_replicates = static_cast<int>(job.floor);
  info.spec.max_failed_share = job.max_failed_share;
  if (!job.may_stop_early) return info;
  if (const auto plan = find_plan(info.paths.root)) info.spec.stop_half_width = plan->study.stop_half_width;
  return info;
}

void Store::visit_records(StudyNumber number, const Visitor& visit) {
  db_.read([&](SQLite::Database& db) {
    Statement query(db, std::string("SELECT floor, idx, state, ") + measure_table[0].key +
                            " FROM runs WHERE job = ? AND state IN ('done', 'failed')");
    query.bind(1, number);
    while (query.executeStep()) {
      const bool done = run_state(query.getColumn(2).getString()) == RunState::done;
      visit({.kind = kind_of(query.getColumn(0)), .index = query.getColumn(1).getInt64()},
            done ? std::optional(query.getColumn(3).getDouble()) : std::nullopt);
    }
  });
}

void Store::drop_open_runs(StudyNumber number, bool replicates_too) {
  db_.write([&](SQLite::Database& db) {
    Statement drop(db, std::string("DELETE FROM runs WHERE job = ? AND state IN ('queued', 'leased')") +
                           (replicates_too ? "" : " AND floor = 0"));
    drop.bind(1, number);
    if (drop.exec() > 0) touch(db, number, clock_());
  });
}

void Store::abort(StudyNumber number, bool, const std::string& why) {
  drop_open_runs(number, true);
  finish(number, JobState::failed, why);
}

std::vector<Job> Store::complete_jobs() {
  return db_.read([&](SQLite::Database& db) {
    Statement query(db, std::string("SELECT ") + job_columns +
                            " FROM jobs AS j WHERE state = 'running' AND planned > 0 AND NOT EXISTS "
                            "(SELECT 1 FROM runs WHERE job = j.number AND state = 'queued') AND NOT EXISTS "
                            "(SELECT 1 FROM runs WHERE job = j.number AND state = 'leased')");
    return all_jobs(query);
  });
}

std::vector<Job> Store::waiting_jobs(const std::string& process) {
  return db_.read([&](SQLite::Database& db) {
    Statement query(db, std::string("SELECT ") + job_columns +
                            " FROM jobs WHERE state IN ('accepted', 'running') AND planned = 0 AND process = ?");
    query.bind(1, process);
    return all_jobs(query);
  });
}

bool Store::start(std::int64_t job) {
  return db_.write([&](SQLite::Database& db) {
    started(db, job, clock_());
    return db.getChanges() > 0;
  });
}

bool Store::is_open(std::int64_t job) {
  return db_.read([&](SQLite::Database& db) {
    Statement query(db, "SELECT 1 FROM jobs WHERE number = ? AND state IN ('accepted', 'running')");
    query.bind(1, job);
    return query.executeStep();
  });
}

std::vector<Run> Store::runs(std::int64_t job, const RunFilter& filter) {
  const std::string measure = filter.measure->key;
  std::string where = "job = ? AND floor = 0 AND idx > ?";
  if (filter.state) where += " AND state = ?";
  if (filter.least) where += " AND " + measure + " >= ?";
  if (filter.below) where += " AND " + measure + " < ?";
  if (filter.most) where += " AND " + measure + " <= ?";
  return db_.read([&](SQLite::Database& db) {
    Statement query(db, "SELECT " + run_columns + " FROM runs WHERE " + where + " ORDER BY idx LIMIT ?");
    int i = 1;
    query.bind(i++, job);
    query.bind(i++, filter.after);
    if (filter.state) query.bind(i++, word(*filter.state));
    for (const auto& bound : {filter.least, filter.below, filter.most})
      if (bound) query.bind(i++, *bound);
    query.bind(i, filter.limit);
    std::vector<Run> runs;
    while (query.executeStep()) runs.push_back(run_of(query));
    return runs;
  });
}

std::optional<Run> Store::run(std::int64_t job, const RunKey& key) {
  return db_.read([&](SQLite::Database& db) -> std::optional<Run> {
    Statement query(db, "SELECT " + run_columns + " FROM runs WHERE job = ? AND floor = ? AND idx = ?");
    query.bind(1, job);
    query.bind(2, key.is_replicate() ? 1 : 0);
    query.bind(3, key.index);
    return query.executeStep() ? std::optional(run_of(query)) : std::nullopt;
  });
}

}  // namespace talus::service

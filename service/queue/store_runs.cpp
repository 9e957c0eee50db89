// The runs of the store: leases and how they end, and the records of those that have ended.

#include <cmath>

#include "queue/sql.hpp"
#include "queue/store.hpp"

namespace talus::service {
namespace {

/// The job of the next run: see Store::claim.
constexpr const char* next_job =
    "SELECT number FROM jobs AS j WHERE state IN ('accepted', 'running') "
    "AND EXISTS (SELECT 1 FROM runs WHERE job = j.number AND state = 'queued') "
    "ORDER BY (SELECT COUNT(*) FROM runs WHERE job = j.number AND state = 'leased'), served, number LIMIT 1";

/// Holds while a claim is current; its five parameters are those of a Claim.
const std::string is_current_claim =
    "job = ? AND level = ? AND kind = ? AND idx = ? AND attempt = ? AND state = 'leased'";

void count_ended(SQLite::Database& db, const Claim& claim, const char* column, Verdict verdict, Milliseconds now) {
  const auto add_one = [](const std::string& counted) { return counted + " = " + counted + " + 1"; };
  std::string changes = add_one(claim.key.is_replicate() ? "replicates_ended" : column);
  if (!claim.key.is_replicate() && verdict != Verdict::not_assessed) changes += ", " + add_one(word(verdict));
  change_job(db, claim.study, now, changes, "TRUE");
}

bool record_done(SQLite::Database& db, const Claim& claim, const Record& result, Milliseconds now) {
  std::string numbers;
  visit_numbers(result, [&](const char* key, const char*, auto) { numbers += key + std::string(" = ?, "); });
  SQLite::Statement update(
      db, "UPDATE runs SET state = 'done', " + numbers +
              "digest = ?, verdict = ?, verdict_reasons = ?, lower_bounds = ?, targets = ?, checksum = ? WHERE " +
              is_current_claim);
  Binder values(update);
  visit_numbers(result, [&](const char*, const char*, auto value) { values << value; });
  values << result.digest << result.verdict << result.objections << result.lower_bounds << targets_text(result)
         << checksum_of(claim.study, claim.key, result) << claim;
  if (update.exec() != 1) return false;
  count_ended(db, claim, "done", result.verdict, now);
  return true;
}

bool record_failed(SQLite::Database& db, const Claim& claim, const Failure& failure, Milliseconds now) {
  const int changed = execute(db,
                              "UPDATE runs SET state = 'failed', crashes = crashes + 1, reason = ?, exit_code = ?, "
                              "signal = ?, log_tail = ? WHERE " +
                                  is_current_claim,
                              failure.reason, failure.exit_code, failure.signal, failure.log_tail, claim);
  if (changed == 1) count_ended(db, claim, "failed", failed_record(claim.key.index, failure.reason).verdict, now);
  return changed == 1;
}

std::vector<double> column(SQLite::Database& db, const std::string& sql, std::int64_t job) {
  std::vector<double> values;
  for (SQLite::Statement query = statement(db, sql, job); query.executeStep();)
    values.push_back(query.getColumn(0).getDouble());
  return values;
}

}  // namespace

void record_ended_runs(SQLite::Database& db, std::int64_t job, RunKind kind, const Records& records, Milliseconds now) {
  for (const auto& [index, record] : records) {
    const Claim claim{.study = job, .key = {.kind = kind, .index = index}, .attempt = 1};
    execute(db,
            "UPDATE runs SET state = 'leased', attempt = 1 "
            "WHERE job = ? AND level = ? AND kind = ? AND idx = ? AND state = 'queued'",
            job, claim.key);
    if (record.done)
      record_done(db, claim, record, now);
    else
      record_failed(db, claim, {.reason = record.reason}, now);
  }
}

std::optional<Claim> Store::claim() {
  const bool any = db_.read([](SQLite::Database& db) { return statement(db, next_job).executeStep(); });
  if (!any) return std::nullopt;  // without a transaction that writes
  return db_.write([&](SQLite::Database& db) -> std::optional<Claim> {
    const Milliseconds now = clock_();
    Claim claim;
    {
      SQLite::Statement query(db, next_job);
      if (!query.executeStep()) return std::nullopt;
      Row(query) >> claim.study;
    }
    {
      SQLite::Statement query = statement(db,
                                          "SELECT level, kind, idx, attempt + 1, crashes FROM runs "
                                          "WHERE job = ? AND state = 'queued' ORDER BY rank LIMIT 1",
                                          claim.study);
      query.executeStep();
      Row(query) >> claim.key >> claim.attempt >> claim.crashes;
    }
    execute(db,
            "UPDATE runs SET state = 'leased', attempt = ?, lease_until = ? "
            "WHERE job = ? AND level = ? AND kind = ? AND idx = ?",
            claim.attempt, now + lease_, claim.study, claim.key);
    execute(db, "UPDATE jobs SET served = (SELECT MAX(served) + 1 FROM jobs) WHERE number = ?", claim.study);
    change_job(db, claim.study, now, "state = 'running', started = ?2", "state = 'accepted'");
    return claim;
  });
}

Store::Renewal Store::renew_leases(std::span<const Claim> held) {
  return db_.write([&](SQLite::Database& db) {
    Renewal renewal;
    const Milliseconds now = clock_();
    SQLite::Statement renew(db, "UPDATE runs SET lease_until = ? WHERE " + is_current_claim);
    for (std::size_t i = 0; i < held.size(); ++i) {
      Binder(renew) << now + lease_ << held[i];
      if (renew.exec() != 1) renewal.lost.push_back(i);
      renew.reset();
    }
    renewal.requeued =
        execute(db, "UPDATE runs SET state = 'queued' WHERE state = 'leased' AND (lease_until < ? OR lease_until > ?)",
                now, now + 2 * lease_);
    return renewal;
  });
}

bool Store::is_current(const Claim& claim) {
  return db_.read([&](SQLite::Database& db) {
    return statement(db, "SELECT 1 FROM runs WHERE " + is_current_claim, claim).executeStep();
  });
}

bool Store::accept(const Claim& claim, const Record& result) {
  return db_.write([&](SQLite::Database& db) { return record_done(db, claim, result, clock_()); });
}

bool Store::fail(const Claim& claim, const Failure& failure) {
  return db_.write([&](SQLite::Database& db) { return record_failed(db, claim, failure, clock_()); });
}

bool Store::give_back(const Claim& claim, bool crashed) {
  return db_.write([&](SQLite::Database& db) {
    return execute(db, "UPDATE runs SET state = 'queued', crashes = crashes + ? WHERE " + is_current_claim, crashed,
                   claim) == 1;
  });
}

std::int64_t Store::requeue_all() {
  return db_.write([&](SQLite::Database& db) {
    const std::int64_t runs = db.exec("UPDATE runs SET state = 'queued' WHERE state = 'leased'");
    execute(db,
            std::string("UPDATE jobs SET message = '' WHERE ") + job_is_open);  // no reason of before holds any more
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
  info.spec.noise_floor_replicates = static_cast<int>(job.replicates);
  info.spec.max_failed_share = job.max_failed_share;
  if (!job.may_stop_early) return info;
  if (const auto plan = find_plan(info.paths.root)) info.spec.stop_half_width = plan->study.stop_half_width;
  return info;
}

void Store::visit_records(StudyNumber number, const Visitor& visit) {
  db_.read([&](SQLite::Database& db) {
    SQLite::Statement query =
        statement(db,
                  std::string("SELECT level, kind, idx, iif(state = 'done', ") + measure_table[0].key +
                      ", NULL) FROM runs WHERE job = ? AND state IN ('done', 'failed')",
                  number);
    while (query.executeStep()) {
      RunKey key;
      std::optional<double> influence_zone;
      Row(query) >> key >> influence_zone;
      visit(key, influence_zone);
    }
  });
}

void Store::drop_open_runs(StudyNumber number, bool replicates_too) {
  db_.write([&](SQLite::Database& db) {
    if (execute(db, "DELETE FROM runs WHERE job = ? AND state IN ('queued', 'leased') AND (kind = 0 OR ?)", number,
                replicates_too) > 0)
      change_job(db, number, clock_(), "state = state", "TRUE");
  });
}

void Store::abort(StudyNumber number, bool, const std::string& why) {
  drop_open_runs(number, true);
  finish(number, JobState::failed, why);
}

std::vector<Job> Store::complete_jobs() {
  return db_.read([&](SQLite::Database& db) {
    return select_jobs(db, std::string("state = 'running' AND planned > 0 AND ") + no_open_runs);
  });
}

std::vector<Job> Store::open_jobs_without_runs(const std::string& process) {
  return db_.read([&](SQLite::Database& db) {
    return select_jobs(db, std::string(job_is_open) + " AND planned = 0 AND process = ?", process);
  });
}

std::vector<Run> Store::runs(std::int64_t job, const RunFilter& filter) {
  const std::string measure = filter.measure->key;
  std::vector<Run> runs;
  db_.read([&](SQLite::Database& db) {
    visit_runs(
        db, [&](Run& run) { runs.push_back(std::move(run)); },
        "job = ? AND level = 0 AND kind = 0 AND idx > ? AND (?3 IS NULL OR state = ?3) AND (?4 IS NULL OR " + measure +
            " >= ?4) AND (?5 IS NULL OR " + measure + " < ?5) AND (?6 IS NULL OR " + measure +
            " <= ?6) ORDER BY idx LIMIT ?7",
        job, filter.after, filter.state, filter.least, filter.below, filter.most, filter.limit);
  });
  return runs;
}

std::optional<Run> Store::run(std::int64_t job, const RunKey& key) {
  std::optional<Run> found;
  db_.read([&](SQLite::Database& db) {
    visit_runs(
        db, [&](Run& run) { found = std::move(run); }, "job = ? AND level = ? AND kind = ? AND idx = ?", job, key);
  });
  return found;
}

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
            Record record = run.result ? *run.result : failed_record(run.key.index, run.failure->reason);
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
    sample.quality = job.quality;
    sample.complete = job.done + job.failed == job.planned;
    // The index holds the measures of all runs that are done, in order, and nothing else: a narrow scan.
    const std::string of_done =
        " FROM runs INDEXED BY runs_measures WHERE job = ? AND level = 0 AND state = 'done' AND " + key +
        " IS NOT NULL";
    const std::string done = "SELECT " + key + of_done;
    if (job.replicates_ended > 0) sample.noise = column(db, done + " AND kind = 0 AND idx = 0", job.number);
    const std::vector<double> replicates = column(db, done + " AND kind = 1 ORDER BY idx", job.number);
    sample.noise.insert(sample.noise.end(), replicates.begin(), replicates.end());
    if (!stop_half_width) {
      sample.values = column(db, done + " AND kind = 0 ORDER BY idx", job.number);
      for (const double index : column(db, "SELECT idx" + of_done + " AND kind = 0 ORDER BY idx", job.number))
        sample.realizations.push_back(static_cast<std::int64_t>(index));
      sample.censored = column(db,
                               "SELECT " + key +
                                   " FROM runs WHERE job = ? AND level = 0 AND kind = 0 AND state = 'done' AND "
                                   "instr(' ' || lower_bounds || ' ', ' " +
                                   key + " ') > 0",
                               job.number);
      return sample;
    }
    StopRule rule(stop_half_width);
    sample.failed = 0;
    sample.quality = {};
    SQLite::Statement query =
        statement(db,
                  "SELECT idx, iif(state = 'done', influence_zone_m, NULL), verdict, reason, lower_bounds, " + key +
                      " FROM runs WHERE job = ? AND level = 0 AND kind = 0 AND state IN "
                      "('done', 'failed') ORDER BY idx",
                  job.number);
    while (!rule.size() && query.executeStep()) {
      std::int64_t index = 0;
      std::optional<double> influence_zone, value;
      std::string reason;
      Record record{.done = true};
      Row(query) >> index >> influence_zone >> record.verdict >> reason >> record.lower_bounds >> value;
      rule.add(index, influence_zone);
      sample.quality.add(influence_zone ? record : failed_record(index, reason));
      if (!influence_zone) {
        ++sample.failed;
      } else if (value) {
        sample.values.push_back(*value);
        sample.realizations.push_back(index);
      }
      if (value && influence_zone && record.is_lower_bound(measure)) sample.censored.push_back(*value);
    }
    sample.complete = sample.complete || rule.size();
    return sample;
  });
}

}  // namespace talus::service

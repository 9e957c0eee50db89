// Damage to the rows of the queue: found by their checksums, and made good from what else is known.

#include <cmath>
#include <map>

#include "queue/sql.hpp"
#include "queue/store.hpp"
#include "support/digest.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

/// The counts of a job that its runs determine.
struct Counts {
  std::int64_t done = 0, failed = 0, sound = 0, doubtful = 0, replicates_ended = 0;
  bool operator==(const Counts&) const = default;

  void add(const Run& run) {
    const bool is_done = run.state == RunState::done, has_failed = run.state == RunState::failed;
    if (run.key.is_replicate()) {
      replicates_ended += is_done || has_failed ? 1 : 0;
      return;
    }
    done += is_done ? 1 : 0;
    failed += has_failed ? 1 : 0;
    sound += is_done && run.result->verdict == Verdict::sound ? 1 : 0;
    doubtful += is_done && run.result->verdict == Verdict::doubtful ? 1 : 0;
  }
};

Counts counts_of(const Job& job) {
  return {.done = job.done,
          .failed = job.failed,
          .sound = job.quality.sound,
          .doubtful = job.quality.doubtful,
          .replicates_ended = job.replicates_ended};
}

}  // namespace

std::string checksum_of(std::int64_t job, const RunKey& key, const Record& record) {
  std::string text = std::to_string(job) + '/' + std::to_string(key.level) + '/' + work_name(key);
  visit_numbers(record, [&](const char* name, const char*, auto value) {
    if (!std::isnan(static_cast<double>(value))) text += std::string(";") + name + '=' + to_text(value);
  });
  for (const std::string& part :
       {record.digest, std::string(word(record.verdict)), record.objections, record.lower_bounds})
    text += ';' + part;
  if (const std::optional<std::string> targets = targets_text(record)) text += ';' + *targets;
  return hex_digits(fnv1a64(text));
}

std::optional<std::string> targets_text(const Record& record) {
  return record.targets.empty() ? std::nullopt : std::optional(outcomes_json(record.targets).dump());
}

bool read_targets_text(const std::optional<std::string>& text, Record& record) try {
  if (text) record.targets = read_outcomes(Json::parse(*text));
  return true;
} catch (const Json::exception&) {
  return false;
} catch (const IoError&) {
  return false;
}

std::vector<std::string> Store::repair_rows() {
  std::vector<std::string> found;
  db_.write([&](SQLite::Database& db) {
    std::map<std::int64_t, Counts> counts;
    std::vector<std::pair<std::int64_t, RunKey>> damaged;
    visit_runs(
        db,
        [&](const Run& run) {
          counts[run.job].add(run);
          if (run.damaged) damaged.emplace_back(run.job, run.key);
        },
        "TRUE");
    std::set<std::int64_t> concerned;
    for (const auto& [number, key] : damaged) {
      const std::optional<Job> job = one_job(db, number);
      execute(db, "DELETE FROM runs WHERE job = ? AND level = ? AND kind = ? AND idx = ?", number, key);
      if (!job) continue;
      concerned.insert(number);
      found.push_back("job " + job->id + ": the record of " + run_name(key));
    }
    for (const Job& job : select_jobs(db, "planned > 0 AND state != 'dismissed'")) {
      if (!concerned.contains(job.number) && counts[job.number] == counts_of(job)) continue;
      if (concerned.contains(job.number)) {
        insert_runs(db, job.number, job.replicates, job.planned);
        change_job(db, job.number, clock_(), reopened, "TRUE");
      } else {
        found.push_back("job " + job.id + ": its counts");
      }
      change_job(db, job.number, clock_(), recounted, "TRUE");
    }
  });
  return found;
}

bool Store::restore(const Job& job, const NewJob& right) {
  const auto fixed = [](const NewJob& of) {
    return std::tuple(of.subject, of.title, of.inputs, of.seed, of.replicates, of.max_failed_share, of.may_stop_early,
                      of.case_hash, of.particles, of.steps);
  };
  if (fixed(job) == fixed(right)) return false;
  db_.write([&](SQLite::Database& db) {
    change_job(db, job.number, clock_(),
               "subject = ?3, title = ?4, inputs = ?5, seed = ?6, replicates = ?7, max_failed_share = ?8, "
               "may_stop_early = ?9, case_hash = ?10, particles = ?11, steps = ?12",
               "TRUE", right.subject, right.title, right.inputs, right.seed, right.replicates, right.max_failed_share,
               right.may_stop_early, right.case_hash, right.particles, right.steps);
  });
  return true;
}

}  // namespace talus::service

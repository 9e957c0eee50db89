// What Jobs does about files of a job that are damaged or lost.

#include "base/json.hpp"
#include "jobs/jobs.hpp"
#include "jobs/repair.hpp"

namespace talus::service {

namespace fs = std::filesystem;

void Jobs::retry(const Job& job, const Store::Response& response) {
  if (ended(job.state)) check_queue(job.subject);  // it will be open again
  repair(job);
  const std::vector<RunKey> lost = lost_results(data_, job, store_);
  store_.requeue_lost(job.number, lost);
  const std::int64_t failed = store_.retry_failed(job.number, response);
  if (lost.empty() && failed == 0 && job.state == JobState::successful) publish_again(job);
  scheduler_.wake(job.number);
}

void Jobs::repair(const Job& job) {
  const std::lock_guard one_at_a_time(changing_study_);
  try {
    const fs::path case_file = checked_case(data_, job);
    const TemporaryDirectory scratch = scratch_directory();
    const fs::path made = scratch / "study";
    const CommandOutput prepared = prepare(case_file, {made}, job.planned, job.seed, {job.subject});
    if (!prepared.ok()) throw IoError("the study cannot be prepared again: " + prepared.err);
    repair_directory(data_, job, made);
  } catch (const IoError& e) {
    log_error("not_repaired", {{"job", job.id}, {"why", e.what()}});
    throw Refusal(reason::conflict, "files of the job are lost: the operator can restore them from a backup");
  }
}

Plan Jobs::plan_of(const Job& job) {
  const auto found = [&]() -> std::optional<Plan> {
    try {
      return find_plan(data_.job(job.id));
    } catch (const IoError&) {
      return std::nullopt;
    }
  };
  std::optional<Plan> plan = found();
  if (!plan) {
    repair(job);
    plan = find_plan(data_.job(job.id));
  }
  plan->study.realizations = job.planned;
  return std::move(*plan);
}

void Jobs::publish_again(const Job& job) {
  publish({data_.job(job.id)}, plan_of(job), store_.records(job.number, RunKind::realization),
          store_.records(job.number, RunKind::replicate));
}

}  // namespace talus::service

// What the end of a child means: the second half of the scheduler.

#include <signal.h>

#include "base/log.hpp"
#include "jobs/scheduler.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using executor::last_line;
using executor::ProcessEnd;
using executor::tail;

constexpr std::size_t tail_bytes = 4000;
constexpr std::size_t max_summary_bytes = std::size_t{256} << 20;
constexpr int publish_attempts = 3;

Json run_fields(const Claim& claim) {
  return {{"job", claim.job_id}, {"run", claim.run.index}, {"floor", claim.run.floor}, {"attempt", claim.attempt}};
}

}  // namespace

void Scheduler::clear_work(const StudyDirectory& directory, const RunKey& run) {
  std::error_code ignored;
  fs::remove_all(directory.work(run), ignored);
  fs::remove(directory.log(run), ignored);
}

void Scheduler::settle(Worker& worker) {
  const executor::Ended& how = *worker.how;
  const ProcessEnd end = how.end;
  if (worker.lost || !store_.is_current(worker.claim)) {
    ++done_.stale;
    if (!store_.is_open(worker.claim.run.job)) clear_work(worker.study, worker.claim.run);
    return;
  }
  if (how.taken) return settle_broken(worker, {.reason = how.why}, false);
  const std::string log = tail(worker.study.log(worker.claim.run), tail_bytes);
  const std::string said = last_line(log).empty() ? "" : ": " + last_line(log);
  RunFailure failure;
  failure.log_tail = log;
  end.signal ? failure.signal = end.signal : failure.exit_code = end.exit_code;
  if (!end.signal && end.exit_code == Exit::ok) return settle_result(worker);
  if (how.timed_out || end.signal == SIGXCPU) {
    failure.reason = "took longer than the limit of " + std::to_string(config_.time_limit.count()) + " s";
    return settle_failure(worker, failure);
  }
  const bool asked =
      end.exit_code == Exit::interrupted || end.exit_code == Exit::sigint || end.exit_code == Exit::sigterm;
  if (draining_ && (end.signal || asked)) return settle_broken(worker, failure, false);
  if (end.signal || asked) {
    failure.reason = !how.why.empty() ? how.why
                     : end.signal     ? "killed: " + executor::signal_text(end.signal)
                                      : "stopped from outside";
    failure.reason += said;
    return settle_broken(worker, failure, true);
  }
  failure.reason = (end.exit_code == Exit::diverged ? "diverged" : "exit code " + std::to_string(end.exit_code)) + said;
  if (end.exit_code != Exit::io) return settle_failure(worker, failure);
  if (how.resumed) fs::remove_all(worker.study.work(worker.claim.run));  // a checkpoint that it cannot go on from
  settle_broken(worker, failure, room_on_disk());
}

void Scheduler::settle_result(Worker& worker) {
  const fs::path left = worker.study.work(worker.claim.run) / "result.json";
  const std::optional<Job> job = job_of(worker.claim);
  const auto result = read_result(left, worker.claim.run, worker.claim.seed, job->case_hash);
  const auto placed = read_result(worker.study.result(worker.claim.run), worker.claim.run, worker.claim.seed,
                                  job->case_hash);  // moved, but not recorded, the last time we tried
  if (!result && !placed)
    return settle_broken(worker, {.reason = "it ended well but left no readable result", .exit_code = 0}, true);
  if (!placed) rename_durably(left, worker.study.result(worker.claim.run));
  if (!store_.accept(worker.claim, placed ? *placed : *result)) {
    ++done_.stale;
    return;
  }
  ++done_.done;
  done_.wall_clock_ms += static_cast<std::int64_t>(1000.0 * (placed ? *placed : *result).wall_clock);
  clear_work(worker.study, worker.claim.run);
  std::error_code ignored;
  fs::remove(worker.study.failure(worker.claim.run), ignored);
}

void Scheduler::settle_failure(Worker& worker, const RunFailure& failure) {
  write_failure(worker.study, worker.claim.run, failure, worker.claim.crashes + 1,
                replay_command(worker.claim.run, worker.claim.seed));
  if (store_.fail(worker.claim, failure)) ++done_.failed;
  clear_work(worker.study, worker.claim.run);
  Json fields = run_fields(worker.claim);
  fields["why"] = failure.reason;
  log_info("run_failed", fields);
}

/// It broke off: again, unless it has too often.
void Scheduler::settle_broken(Worker& worker, const RunFailure& failure, bool crashed) {
  if (crashed && worker.claim.crashes + 1 >= config_.attempts) {
    RunFailure final = failure;
    final.reason += ", " + std::to_string(worker.claim.crashes + 1) + " times";
    return settle_failure(worker, final);
  }
  store_.give_back(worker.claim, crashed);
  ++(crashed ? done_.crashed : done_.given_back);
  if (!crashed && failure.reason.empty()) return;
  Json fields = run_fields(worker.claim);
  fields["why"] = failure.reason;
  log_info("run_again", fields);
}

void Scheduler::start_publisher(const Job& job, bool interim) {
  const StudyDirectory directory = study(job.id);
  const fs::path log = data_.scratch() / ("stats-" + job.id + ".log");
  publishers_.push_back({.job = job,
                         .study = directory,
                         .process = executor::Process(commands_.stats(directory), log, log),
                         .deadline = Steady::now() + std::chrono::minutes(5),
                         .interim = interim});
}

void Scheduler::settle_publisher(Publisher& publisher, ProcessEnd end) {
  const Job& job = publisher.job;
  if (!store_.is_open(job.number)) return;
  if (end.signal || end.exit_code != Exit::ok) {
    const std::string said = tail(data_.scratch() / ("stats-" + job.id + ".log"), tail_bytes);
    log_error("no_statistics", {{"job", job.id}, {"why", last_line(said)}});
    const bool no_room =
        end.exit_code == Exit::io && !end.signal && !room_on_disk();  // looked at again with the next beat
    if (publisher.interim || no_room || ++publish_failures_[job.number] < publish_attempts) return;
    store_.finish(job.number, JobState::failed, "the statistics cannot be made: " + last_line(said));
    return;
  }
  Json realizations;
  try {
    realizations =
        Json::parse(find_file(publisher.study.summary(), max_summary_bytes).value_or("null")).at("realizations");
  } catch (const nlohmann::json::exception& e) {
    log_error("no_statistics", {{"job", job.id}, {"why", e.what()}});
    store_.finish(job.number, JobState::failed, "the statistics cannot be read");
    return;
  }
  if (publisher.interim) {
    if (realizations.at("stopped_early") == true) {
      store_.stop_early(job.number);
      next_beat_ = {};  // the workers that lost their leases are ended now
    }
    return;
  }
  const auto done = realizations.at("done").get<std::int64_t>(), failed = realizations.at("failed").get<std::int64_t>();
  const bool too_many =
      done == 0 || static_cast<double>(failed) > job.max_failed_share * static_cast<double>(done + failed);
  std::string message = std::to_string(done) + " realizations done";
  if (failed > 0) message += ", " + std::to_string(failed) + " failed";
  if (too_many) message += ": more than the share of " + Json(job.max_failed_share).dump() + " that may";
  if (realizations.at("stopped_early") == true) message += "; stopped early, the mean is known well enough";
  if (store_.finish(job.number, too_many ? JobState::failed : JobState::successful, message)) {
    log_info("job_ended",
             {{"job", job.id}, {"state", too_many ? "failed" : "successful"}, {"done", done}, {"failed", failed}});
    std::error_code ignored;
    fs::remove_all(publisher.study.root / "work", ignored);
  }
}

}  // namespace talus::service

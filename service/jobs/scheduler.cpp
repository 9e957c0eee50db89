#include "jobs/scheduler.hpp"

#include <algorithm>

#include "base/json.hpp"
#include "executor/slurm.hpp"
#include "jobs/orphans.hpp"
#include "jobs/repair.hpp"
#include "jobs/reserve.hpp"
#include "study/estimator.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr milliseconds poll_interval{10};
constexpr milliseconds idle_interval{500};
constexpr milliseconds trouble_interval{1000};
constexpr milliseconds reasons_interval{2000};
constexpr milliseconds removal_interval{5000};   ///< between attempts to remove a directory
constexpr milliseconds longest_echo_wait{1000};  ///< between looks at waiting echo jobs: the clock may be set
constexpr std::int64_t pages_at_a_time = 2000;   ///< of the database, returned to the file system

/// Removes a directory. @return false where a network file system still holds it; a later attempt may succeed
bool removed(const fs::path& directory) {
  std::error_code error;
  fs::remove_all(directory, error);
  if (error) log_info("not_removed_yet", {{"directory", directory.string()}, {"why", error.message()}});
  return !error;
}

std::unique_ptr<executor::Executor> make_executor(const Config& config) {
  if (!config.slurm) return executor::make_local_executor(config.workers);
  const auto note = [](const std::string& text) { log_info("slurm", {{"said", text}}); };
  return std::make_unique<executor::SlurmExecutor>(*config.slurm, DataDirectory{config.data}.slurm(),
                                                   std::vector{config.program.string(), std::string("array-task")},
                                                   config.threads, note);
}

}  // namespace

Scheduler::Scheduler(const Config& config, Store& store)
    : config_(config), data_{config.data}, store_(store), engine_(store, make_executor(config), engine_options()) {}

EngineOptions Scheduler::engine_options() {
  return {.attempts = config_.attempts,
          .command =
              [this](const StudyInfo& study, const RunKey& key) {
                return study_run(config_, study, key, store_.job(study.name)->particles);
              },
          .room_on_disk = [this] { return room_on_disk(); },
          .report = [this](const RunEvent& event) { count(event); }};
}

void Scheduler::count(const RunEvent& event) {
  using Kind = RunEvent::Kind;
  ++counters_.ended[static_cast<std::size_t>(event.kind)];
  if (event.kind == Kind::done) counters_.wall_clock_ms += static_cast<std::int64_t>(1000.0 * event.wall_clock);
  if (!event.reason.empty())
    log_info(event.kind == Kind::failed ? "run_failed" : "run_again", {{"job", event.study.name},
                                                                       {"run", event.claim.key.index},
                                                                       {"replicate", event.claim.key.is_replicate()},
                                                                       {"attempt", event.claim.attempt},
                                                                       {"why", event.reason}});
  changes_.notify();
}

void Scheduler::start() {
  make_reserve(data_);
  const std::int64_t requeued = with_reserve(data_, [&] {
    put_orphans_aside(data_, store_.job_ids());
    for (const std::string& what : store_.repair_rows()) log_error("damaged_row", {{"what", what}});
    check_job_records(data_, store_);
    return store_.requeue_all();
  });
  if (requeued > 0) log_info("requeued", {{"runs", requeued}, {"why", "an earlier talusd held them"}});
  thread_ = std::thread([this] { loop(); });
}

void Scheduler::wake(std::optional<std::int64_t> job) {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
    if (job) changed_.insert(*job);
  }
  wake_.notify_one();
  changes_.notify();
}

void Scheduler::wait_for(milliseconds limit) {
  std::set<StudyNumber> changed;
  {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, limit, [&] { return woken_ || draining_; });
    if (!woken_) return;
    woken_ = false;
    changed.swap(changed_);
  }
  for (const StudyNumber job : changed) engine_.forget(job);
  removing_ |= !changed.empty();
  shrinking_ |= !changed.empty();
  read_queue_ = true;
  next_renewal_ = {};
}

void Scheduler::loop() {
  while (!draining_) {
    try {
      tick();
      set_trouble("");
      wait_for(until_next_tick());
    } catch (const std::exception& e) {
      // A full disk or a database that cannot be written: runs continue, and how they end is recorded later.
      set_trouble(e.what());
      read_queue_ = true;
      free_space();
      wait_for(trouble_interval);
    }
  }
  end_runs();
}

void Scheduler::set_trouble(const std::string& why) {
  const bool before = !trouble().empty();
  if (before && why.empty()) log_info("scheduler_continues");
  if (!before && !why.empty()) log_error("scheduler_waits", {{"why", why}});
  {
    const std::lock_guard lock(mutex_);
    trouble_ = why;
  }
  if (before == why.empty()) changes_.notify();
}

std::string Scheduler::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

milliseconds Scheduler::until_next_tick() const {
  if (engine_.running() > 0 || shrinking_) return poll_interval;
  if (next_echo_ == Steady::time_point::max()) return idle_interval;
  const auto left = std::chrono::ceil<milliseconds>(next_echo_ - Steady::now());
  return std::clamp(left, milliseconds(0), idle_interval);
}

/// On a full disk nothing else can be done.
void Scheduler::free_space() {
  try {
    if (removing_ && Steady::now() >= next_removal_) remove_dismissed();
  } catch (const std::exception& e) {
    log_error("not_removed_yet", {{"why", e.what()}});
  }
}

void Scheduler::tick() {
  read_queue_ |= engine_.record_ended();
  counters_.running = static_cast<int>(engine_.running());
  if (Steady::now() >= next_renewal_) {
    engine_.renew_claims();
    read_queue_ = true;
    next_renewal_ = Steady::now() + config_.lease / 6;
  }
  run_echo();
  if (removing_ && Steady::now() >= next_removal_) remove_dismissed();
  if (shrinking_) shrink_queue();
  if (read_queue_) {
    engine_.start_runs();
    counters_.running = static_cast<int>(engine_.running());
    read_queue_ = finish_complete();
    changes_.notify();
  }
  if (Steady::now() < next_reasons_) return;
  next_reasons_ = Steady::now() + reasons_interval;
  make_reserve(data_);
  note_pending_reasons();
}

bool Scheduler::room_on_disk() const {
  return disk_left(config_.data) >= std::max(config_.quotas.disk_bytes / 2, least_disk_bytes);
}

/// The statistics of jobs whose runs have all ended. @return whether runs have been queued again instead
bool Scheduler::finish_complete() {
  bool requeued = false;
  for (const Job& job : store_.complete_jobs()) {
    try {
      requeued |= !finish(job);
    } catch (const StorageError&) {
      throw;
    } catch (const std::exception& e) {  // of this job: the others go on
      log_error("no_statistics", {{"job", job.id}, {"why", e.what()}});
      if (!room_on_disk()) throw;  // tried again when there is room
      store_.finish(job.number, JobState::failed, std::string("the statistics cannot be written: ") + e.what());
    }
    engine_.forget(job.number);
    changes_.notify();
  }
  return requeued;
}

/// @return false where results are missing: their runs are queued again
bool Scheduler::finish(const Job& job) {
  const StudyPaths paths{data_.job(job.id)};
  if (const std::vector<RunKey> missing = missing_results(data_, job, store_); !missing.empty()) {
    log_error("results_missing", {{"job", job.id}, {"runs", missing.size()}});
    store_.requeue_lost(job.number, missing);
    return false;
  }
  std::optional<Plan> plan = find_plan(paths.root);
  if (!plan) throw IoError("there is no plan.json in " + paths.root.string());
  plan->study.realizations = job.planned;
  const StudySummary summary = publish(paths, *plan, store_.records(job.number, RunKind::realization),
                                       store_.records(job.number, RunKind::replicate));
  const bool too_many = too_many_failed(summary.failed(), summary.done(), job.planned, job.max_failed_share);
  std::string message = std::to_string(summary.done()) + " realizations done";
  if (summary.failed() > 0) message += ", " + std::to_string(summary.failed()) + " failed";
  if (summary.replicates_failed() > 0)
    message += ", " + std::to_string(summary.replicates_failed()) + " of " + std::to_string(job.replicates) +
               " replicates for the numerical noise failed";
  if (too_many) message += ": more than max_failed_share = " + to_text(job.max_failed_share) + " of those planned";
  if (const std::string quality = quality_line(summary.quality_json()); !quality.empty()) message += "; " + quality;
  if (summary.stopped_early()) message += "; stopped early: the mean has the requested precision";
  if (!store_.finish(job.number, too_many ? JobState::failed : JobState::successful, message)) return true;
  log_info("job_ended", {{"job", job.id},
                         {"state", too_many ? "failed" : "successful"},
                         {"done", summary.done()},
                         {"failed", summary.failed()}});
  std::error_code ignored;
  fs::remove_all(paths.work(), ignored);
  return true;
}

/// Records why the executor runs nothing of a job.
void Scheduler::note_pending_reasons() {
  const std::set<StudyNumber> running = engine_.studies_running();
  std::set<StudyNumber> concerned = running;
  concerned.merge(std::exchange(pending_, {}));  // also those with a reason that may not hold any more
  for (const StudyNumber number : concerned) {
    const std::optional<Job> job = store_.job(number);
    if (!job || ended(job->state)) continue;
    const std::string why = running.contains(number) ? engine_.executor().pending_reason(job->id) : "";
    if (!why.empty()) pending_.insert(number);
    if (job->message == why) continue;
    store_.note_pending_reason(job->number, why);
    if (!why.empty()) log_info("waits", {{"job", job->id}, {"why", why}});
    changes_.notify();
  }
}

/// Starts and ends echo jobs, which only wait. Nothing is read before the next of them is due.
void Scheduler::run_echo() {
  if (!read_queue_ && Steady::now() < next_echo_) return;
  next_echo_ = Steady::time_point::max();
  for (const Job& job : store_.open_jobs_without_runs("echo")) {
    const auto pause = static_cast<Milliseconds>(1000.0 * Json::parse(job.inputs).value("pause", 0.0));
    const Milliseconds now = system_now(), waited = job.started ? now - *job.started : 0;
    const bool due = job.state == JobState::running && (waited >= pause || waited < 0);  // < 0: the clock was set back
    if (due)
      store_.finish(job.number, JobState::successful, "done");
    else
      next_echo_ = std::min(
          next_echo_, Steady::now() + std::clamp(milliseconds(pause - waited), milliseconds(0), longest_echo_wait));
    if (job.state == JobState::accepted) store_.start(job.number);
    if (due || job.state == JobState::accepted) changes_.notify();
  }
}

/// Returns the pages of deleted rows to the file system, some at a time. What fails is tried after the next dismissal.
void Scheduler::shrink_queue() {
  shrinking_ = false;
  shrinking_ = store_.shrink(pages_at_a_time);
}

/// Removes the directories of dismissed jobs, each once none of its processes runs. No other directory is removed.
void Scheduler::remove_dismissed() {
  removing_ = false;
  const std::set<std::string> dismissed = store_.job_ids(JobState::dismissed);
  std::set<std::string> at_work;
  for (const StudyNumber number : engine_.studies_running()) at_work.insert(store_.job(number)->id);
  for (const auto& entry : fs::directory_iterator(data_.jobs())) {
    const std::string id = entry.path().filename().string();
    if (!dismissed.contains(id)) continue;
    if (at_work.contains(id)) {
      removing_ = true;
    } else if (!removed(entry.path())) {
      removing_ = true;
      next_removal_ = Steady::now() + removal_interval;
    }
  }
}

void Scheduler::drain() {
  if (draining_.exchange(true)) return;
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

/// In the scheduler's own thread: local runs ask the kernel to kill them when the thread that started them ends.
void Scheduler::end_runs() {
  const bool leave = engine_.executor().outlives_this_process();  // the next talusd adopts them
  const Steady::time_point end = Steady::now() + config_.grace;
  log_info("draining", {{"workers", engine_.running()}, {"grace_s", leave ? 0 : config_.grace.count()}});
  if (!leave) engine_.stop();
  while (!leave && engine_.running() > 0 && Steady::now() < end) {
    try {
      engine_.record_ended();
    } catch (const std::exception& e) {
      log_error("drain", {{"why", e.what()}});
      std::this_thread::sleep_for(trouble_interval);
    }
    std::this_thread::sleep_for(poll_interval);
  }
  engine_.close();
}

}  // namespace talus::service

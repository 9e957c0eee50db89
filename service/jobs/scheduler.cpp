#include "jobs/scheduler.hpp"

#include <signal.h>

#include <algorithm>

#include "base/log.hpp"
#include "executor/local.hpp"
#include "executor/slurm.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr milliseconds poll_interval{10};
constexpr milliseconds idle_interval{500};
constexpr milliseconds trouble_interval{1000};
constexpr milliseconds interim_interval{2000};
constexpr milliseconds removal_interval{5000};                   ///< until what could not be removed is tried again
constexpr std::uint64_t crowded_bytes = std::uint64_t{8} << 20;  ///< a run that cannot write then is not to blame

/// Could it be? What a network file system does not let go yet is tried again, and nothing else waits for it.
bool removed(const fs::path& directory) {
  std::error_code error;
  fs::remove_all(directory, error);
  if (error) log_info("not_removed_yet", {{"directory", directory.string()}, {"why", error.message()}});
  return !error;
}

std::unique_ptr<executor::Executor> make_executor(const Config& config) {
  if (!config.slurm) return std::make_unique<executor::LocalExecutor>(config.workers);
  const auto note = [](const std::string& text) { log_info("slurm", {{"said", text}}); };
  return std::make_unique<executor::SlurmExecutor>(*config.slurm, DataDirectory{config.data}.slurm(),
                                                   std::vector{config.program.string(), std::string("array-task")},
                                                   config.threads, note);
}

}  // namespace

Scheduler::Scheduler(const Config& config, Store& store, Changes& changes)
    : config_(config),
      data_{config.data},
      store_(store),
      changes_(changes),
      commands_(config),
      lease_(std::chrono::duration_cast<milliseconds>(config.lease).count()),
      executor_(make_executor(config)) {}

Scheduler::~Scheduler() { drain(); }

void Scheduler::start() {
  put_orphans_aside();
  const std::vector<Claim> held = store_.requeue_all();
  if (!held.empty()) log_info("requeued", {{"runs", held.size()}, {"why", "an earlier talusd held them"}});
  thread_ = std::thread([this] { loop(); });
}

void Scheduler::wake(bool dismissed) {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
    dismissed_ |= dismissed;
  }
  wake_.notify_one();
}

void Scheduler::wait_for(milliseconds most) {
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, most, [&] { return woken_ || draining_; });
  if (!woken_) return;
  woken_ = false;
  look_ = true;
  next_beat_ = {};
  removing_ |= std::exchange(dismissed_, false);
}

void Scheduler::loop() {
  while (!draining_) {
    try {
      tick();
      if (told_trouble_) log_info("going_on");
      told_trouble_ = false;
      const bool busy = !workers_.empty() || !publishers_.empty() || echo_waiting_;
      wait_for(busy ? poll_interval : idle_interval);
    } catch (const std::exception& e) {
      // A full disk or a database that cannot be written: workers go on, and what they did is recorded once it can be.
      if (!told_trouble_) log_error("scheduler_waits", {{"why", e.what()}});
      told_trouble_ = true;
      look_ = true;
      std::this_thread::sleep_for(trouble_interval);
    }
  }
  end_workers();
}

void Scheduler::tick() {
  reap();
  if (Steady::now() >= next_beat_) beat();
  run_echo();
  if (removing_ && Steady::now() >= next_removal_) remove_dismissed();
  if (look_) {
    look_ = false;
    fill();
    publish_complete();
  }
  if (Steady::now() < next_interim_) return;
  next_interim_ = Steady::now() + interim_interval;
  publish_interim();
  note_waits();
}

/// Renews the leases of what runs, ends what has lost its own, and puts back what nobody holds.
void Scheduler::beat() {
  std::vector<Claim> claims;
  std::vector<executor::RunId> holders;
  for (const auto& [id, worker] : workers_) {
    claims.push_back(worker.claim);
    holders.push_back(id);
  }
  for (const std::size_t i : store_.beat(claims, lease_).lost) {
    workers_.at(holders[i]).lost = true;
    executor_->kill(holders[i]);
  }
  look_ = true;
  next_beat_ = Steady::now() + config_.lease / 6;
}

void Scheduler::reap() {
  for (const executor::Ended& how : executor_->poll()) workers_.at(how.id).how = how;
  for (auto worker = workers_.begin(); worker != workers_.end();) {
    if (!worker->second.how) {
      ++worker;
      continue;
    }
    settle(worker->second);  // if it throws, the worker stays and is settled later
    worker = workers_.erase(worker);
    done_.running = static_cast<int>(workers_.size());
    look_ = true;
    changes_.announce();
  }
  reap_publishers();
}

void Scheduler::reap_publishers() {
  for (auto publisher = publishers_.begin(); publisher != publishers_.end();) {
    const std::optional<executor::ProcessEnd> end = publisher->process.poll();
    if (!end) {
      if (Steady::now() > publisher->deadline) publisher->process.signal(SIGKILL);
      ++publisher;
      continue;
    }
    settle_publisher(*publisher, *end);
    publisher = publishers_.erase(publisher);
    changes_.announce();
  }
}

bool Scheduler::room_on_disk() {
  return disk_left(config_.data) >= std::max(config_.quotas.disk_bytes / 2, crowded_bytes);
}

/// Starts runs while there are free places, room on the disk and work.
void Scheduler::fill() {
  while (executor_->has_room()) {
    if (!room_on_disk())
      throw std::runtime_error("less disk is left than half of --min-disk, or 8 MiB: no run is started");
    const std::optional<Claim> claim = store_.claim(lease_);
    if (!claim) return;
    try {
      start_worker(*claim);
    } catch (...) {
      store_.give_back(*claim, false);
      throw;
    }
    changes_.announce();
  }
}

/// A result that was finished before talusd was killed counts.
bool Scheduler::adopt(const Claim& claim, const StudyDirectory& study, const Job& job) {
  const fs::path place = study.result(claim.run), left = study.work(claim.run) / "result.json";
  if (const auto result = read_result(place, claim.run, claim.seed, job.case_hash))
    return store_.accept(claim, *result);
  const auto result = read_result(left, claim.run, claim.seed, job.case_hash);
  if (!result) return false;
  rename_durably(left, place);
  const bool accepted = store_.accept(claim, *result);
  clear_work(study, claim.run);
  return accepted;
}

void Scheduler::start_worker(const Claim& claim) {
  const std::optional<Job> job = job_of(claim);
  const StudyDirectory directory = study(claim.job_id);
  for (const char* name : {"runs", "floor", "work", "profiles"}) fs::create_directories(directory.root / name);
  if (adopt(claim, directory, *job)) {
    ++done_.done;
    look_ = true;
    return;
  }
  const fs::path work = directory.work(claim.run);
  const executor::RunId id = executor_->start({.name = claim.job_id + "/" + work.filename().string(),
                                               .group = claim.job_id,
                                               .command = commands_.run(directory, claim, job->particles),
                                               .directory = work,
                                               .log = directory.log(claim.run)});
  workers_.emplace(id, Worker{.claim = claim, .study = directory});
  done_.running = static_cast<int>(workers_.size());
}

/// The statistics of jobs whose runs have all ended.
void Scheduler::publish_complete() {
  for (const Job& job : store_.complete_jobs()) {
    const bool under_way = std::any_of(publishers_.begin(), publishers_.end(),
                                       [&](const Publisher& p) { return p.job.number == job.number; });
    if (!under_way) start_publisher(job, false);
  }
}

std::set<std::string> Scheduler::jobs_at_work() const {
  std::set<std::string> ids;
  for (const auto& [id, worker] : workers_) ids.insert(worker.claim.job_id);
  return ids;
}

/// Jobs that the executor cannot go on with say why.
void Scheduler::note_waits() {
  const std::set<std::string> at_work = jobs_at_work();
  std::set<std::string> concerned = at_work;
  concerned.merge(std::exchange(waiting_, {}));  // those that said so and have nothing at work any more
  for (const std::string& id : concerned) {
    const std::string why = at_work.contains(id) ? executor_->waits(id) : "";
    if (!why.empty()) waiting_.insert(id);
    const std::optional<Job> job = store_.job(id);
    if (!job || ended(job->state) || job->message == why) continue;
    store_.note_waits(job->number, why);
    if (!why.empty()) log_info("waits", {{"job", id}, {"why", why}});
    changes_.announce();
  }
}

/// Looks whether a study that may stop early may do so.
void Scheduler::publish_interim() {
  for (const std::string& id : jobs_at_work()) {
    const std::optional<Job> job = store_.job(id);
    if (!job || !job->may_stop_early || ended(job->state) || interim_published_[job->number] == job->done) continue;
    const bool under_way = std::any_of(publishers_.begin(), publishers_.end(),
                                       [&](const Publisher& p) { return p.job.number == job->number; });
    if (under_way) continue;
    interim_published_[job->number] = job->done;
    start_publisher(*job, true);
  }
}

/// Echo does nothing but wait.
void Scheduler::run_echo() {
  if (!echo_waiting_ && !look_) return;
  const std::vector<Job> waiting = store_.waiting_jobs("echo");
  echo_waiting_ = !waiting.empty();
  for (const Job& job : waiting) {
    const double pause = Json::parse(job.inputs).value("pause", 0.0);
    if (job.state == JobState::accepted) {
      store_.start(job.number);
    } else if (static_cast<double>(system_now() - *job.started) >= 1000.0 * pause || system_now() < *job.started) {
      store_.finish(job.number, JobState::successful, "done");
    } else {
      continue;
    }
    changes_.announce();
  }
}

/// Removes the directories of dismissed jobs, each once none of its processes runs. A directory of any other job, and
/// one that the queue does not know, stays.
void Scheduler::remove_dismissed() {
  removing_ = false;
  const std::set<std::string> dismissed = store_.dismissed_ids();
  for (const auto& entry : fs::directory_iterator(data_.jobs())) {
    if (!dismissed.contains(entry.path().filename().string())) continue;
    const bool works = std::any_of(workers_.begin(), workers_.end(),
                                   [&](const auto& worker) { return worker.second.study.root == entry.path(); });
    const bool publishes = std::any_of(publishers_.begin(), publishers_.end(),
                                       [&](const Publisher& p) { return p.study.root == entry.path(); });
    if (works || publishes) {
      removing_ = true;
    } else if (!removed(entry.path())) {
      removing_ = true;
      next_removal_ = Steady::now() + removal_interval;
    }
  }
}

/// At start: moves directories that the queue does not know to DATA/orphans. They may be the results of a queue that
/// was lost or restored from an older backup. Only unfinished submissions and scratch files are deleted.
void Scheduler::put_orphans_aside() {
  std::set<std::string> known = store_.known_ids();
  known.merge(store_.dismissed_ids());
  for (const auto& entry : fs::directory_iterator(data_.jobs())) {
    const std::string name = entry.path().filename().string();
    if (known.contains(name)) continue;
    if (name.starts_with(DataDirectory::unfinished_prefix)) {
      removed(entry.path());
      continue;
    }
    fs::path place = data_.orphans() / name;
    for (int copy = 2; fs::exists(fs::symlink_status(place)); ++copy)
      place = data_.orphans() / (name + "-" + std::to_string(copy));
    fs::create_directories(data_.orphans());
    fs::rename(entry.path(), place);
    ++done_.orphans;
    log_error("orphan", {{"directory", entry.path().string()},
                         {"moved_to", place.string()},
                         {"why", "the queue knows no job of this name; was the queue lost or restored?"}});
  }
  removed(data_.scratch());
  fs::create_directories(data_.scratch());
}

void Scheduler::drain() {
  if (stopped_.exchange(true)) return;
  draining_ = true;
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

/// In the scheduler's own thread: local runs ask the kernel to kill them when the thread that started them ends.
void Scheduler::end_workers() {
  const bool leave = executor_->survives_us();  // the next talusd takes them over
  const Steady::time_point end = Steady::now() + config_.grace;
  log_info("draining", {{"workers", workers_.size()}, {"grace_s", leave ? 0 : config_.grace.count()}});
  if (!leave) executor_->stop_all();
  while (!leave && !workers_.empty() && Steady::now() < end) {
    try {
      reap();
    } catch (const std::exception& e) {
      log_error("drain", {{"why", e.what()}});
      std::this_thread::sleep_for(trouble_interval);
    }
    std::this_thread::sleep_for(poll_interval);
  }
  for (const auto& [id, worker] : workers_) {
    try {
      store_.give_back(worker.claim, false);
    } catch (const std::exception&) {  // the next talusd puts it back
    }
  }
  workers_.clear();
  publishers_.clear();
  executor_.reset();
}

}  // namespace talus::service

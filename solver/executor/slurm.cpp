#include "executor/slurm.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "support/files.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t probe_runs = 8;         ///< runs at a time while their duration is unknown
constexpr int misses = 2;                     ///< polls without the task after which it is gone
constexpr std::chrono::seconds patience{30};  ///< time in which a continuing study must adopt its runs

constexpr const char* never_submitted = "never submitted";

/// Ends of a task that say nothing about the run in it. COMPLETED: it was asked to stop, and left a checkpoint.
bool is_innocent(const std::string& state) {
  constexpr std::array all{"COMPLETED", "NODE_FAIL", "PREEMPTED", "BOOT_FAIL", never_submitted};
  return std::find(all.begin(), all.end(), state) != all.end();
}

}  // namespace

SlurmExecutor::SlurmExecutor(SlurmConfig config, fs::path directory, std::vector<std::string> array_task, int threads,
                             Note note)
    : config_(std::move(config)),
      directory_(std::move(directory)),
      array_task_(std::move(array_task)),
      threads_(threads),
      note_(std::move(note)),
      poll_(std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(config_.poll_s))),
      recovered_(Steady::now()) {
  recover();
}

std::size_t SlurmExecutor::open_tasks() const {
  std::size_t n = 0;
  for (const Batch& batch : batches_)
    n += static_cast<std::size_t>(std::count_if(batch.tasks.begin(), batch.tasks.end(), [](const Task& task) {
      return !task.over && std::any_of(task.entries.begin(), task.entries.end(),
                                       [](const Entry& entry) { return entry.id != 0 && !entry.ended; });
    }));
  return n;
}

bool SlurmExecutor::has_room() const { return !stopping_ && unknown_ < probe_runs && load_ < config_.array_tasks; }

void SlurmExecutor::estimate_load(const Run& run, bool waits) {
  const std::optional<double> run_s = times_.of(run.group);
  if (!run_s) ++unknown_;
  if (waits) load_ += run_s ? std::min(1.0, *run_s / config_.task_s) : 1.0;
}

void SlurmExecutor::estimate_all_load() {
  load_ = static_cast<double>(open_tasks());
  unknown_ = 0;
  for (const Entry& waiting : waiting_) estimate_load(waiting.run, true);
  for (const auto& [id, place] : open_) estimate_load(entry(place).run, false);
}

RunId SlurmExecutor::start(const Run& run) {
  const RunId id = ++last_;
  const bool waits = !take_over(run, id);
  if (waits) waiting_.push_back({.run = run, .id = id});
  estimate_load(run, waits);
  return id;
}

void SlurmExecutor::kill(RunId id) {
  const auto waiting = std::find_if(waiting_.begin(), waiting_.end(), [&](const Entry& e) { return e.id == id; });
  if (waiting != waiting_.end()) {
    waiting_.erase(waiting);
    ended_.push_back({.id = id, .end = {.signal = SIGKILL}});
    return;
  }
  const auto at = open_.find(id);
  if (at == open_.end()) return;
  const Place place = at->second;
  entry(place).killed = true;
  place.batch->directory.want_killed(place.run);
  Task& task = place.batch->tasks[place.run.task];
  task.unwanted = std::all_of(task.entries.begin(), task.entries.end(),
                              [](const Entry& e) { return e.ended || e.killed || e.id == 0; });
}

std::string SlurmExecutor::pending_reason(const std::string& group) const {
  std::set<std::string> reasons;
  for (const Batch& batch : batches_)
    for (const Task& task : batch.tasks) {
      if (task.over || task.entries.front().run.group != group) continue;
      if (task.running_since) return {};
      if (!task.reason.empty()) reasons.insert(task.reason);
    }
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "waits in Slurm's queue: " : ", ") + reason;
  return text;
}

void SlurmExecutor::stop_all() {
  stopping_ = true;
  for (const Entry& entry : waiting_) ended_.push_back({.id = entry.id, .preempted = true});
  waiting_.clear();
  for (Batch& batch : batches_)
    for (Task& task : batch.tasks) task.unwanted = true;
  next_cycle_ = next_cancel_ = {};
}

std::vector<Ended> SlurmExecutor::poll() {
  end_calls();
  if (Steady::now() >= next_cycle_) poll_cycle();
  return std::exchange(ended_, {});
}

/// Reads the status files, then applies a reply of squeue that was requested before: a task that had ended by then has
/// written all its files.
void SlurmExecutor::poll_cycle() {
  next_cycle_ = Steady::now() + poll_;
  for (Batch& batch : batches_) collect(batch);
  if (queue_) {
    for (Batch& batch : batches_) reconcile(batch);
    queue_.reset();
  }
  drop_unclaimed();
  drop_finished();
  cancel_unwanted();
  submit();
  ask_queue();
  estimate_all_load();
}

/// Takes in the statuses that are new.
void SlurmExecutor::collect(Batch& batch) {
  for (const RunPlace place : batch.directory.statuses())
    if (place.task < batch.tasks.size() && place.position < batch.tasks[place.task].entries.size())
      take_in(batch, place);
}

void SlurmExecutor::take_in(Batch& batch, RunPlace place) {
  Entry& entry = batch.tasks[place.task].entries[place.position];
  if (entry.ended) return;
  try {
    const RunStatus status = batch.directory.status(place);
    if (status.end.exit_code == 0 && status.end.signal == 0) times_.ended(entry.run.group, status.seconds);
    end(entry, {.end = status.end, .resumed = status.resumed, .timed_out = status.timed_out, .why = status.why});
  } catch (const IoError& e) {  // read again; if it stays so, the task will be gone and the run lost
    if (!std::exchange(entry.told, true)) note_(e.what());
  }
}

void SlurmExecutor::end(Entry& entry, Ended how) {
  entry.ended = true;
  if (entry.id == 0) {
    unclaimed_.erase(entry.run.name);
    return;
  }
  open_.erase(entry.id);
  how.id = entry.id;
  ended_.push_back(std::move(how));
}

/// Which tasks of a batch are gone, with runs that have no status.
void SlurmExecutor::reconcile(Batch& batch) {
  if (queue_begun_ <= batch.since) return;
  if (!batch.job && &batch != submitting_) {  // ours died before it heard from sbatch
    batch.job = queue_->job_named("talus-" + batch.directory.path().filename().string());
    if (batch.job) batch.directory.write_job(*batch.job);
  }
  if (&batch == submitting_) return;
  for (std::size_t i = 0; i < batch.tasks.size(); ++i) {
    Task& task = batch.tasks[i];
    if (task.over) continue;
    const std::optional<QueuedTask> queued =
        batch.job ? queue_->task(*batch.job, static_cast<std::int64_t>(i)) : std::nullopt;
    const bool alive = queued && queued->alive;
    task.missed = alive ? 0 : task.missed + 1;
    task.reason = alive && queued->state == "PENDING" ? queued->reason : "";  // that of an ended one is why it ended
    if (!queued || !queued->running) {
      task.running_since.reset();
    } else {
      if (!task.running_since) task.running_since = queue_begun_;
      const std::chrono::duration<double> runs = queue_begun_ - *task.running_since;
      times_.still_runs(task.entries.front().run.group, runs.count() / static_cast<double>(task.entries.size()));
    }
    if (task.missed < misses) continue;
    // NFS may list a file half a minute late, but opens it by name at once.
    for (std::size_t k = 0; k < task.entries.size(); ++k)
      if (batch.directory.has_status({i, k})) take_in(batch, {i, k});
    mark_lost(batch, i, queued ? queued->state : batch.job ? "forgotten" : never_submitted);
  }
}

/// The task is gone. Its first run without a status is the one that it had begun; the runs after it have not begun.
void SlurmExecutor::mark_lost(Batch& batch, std::size_t index, const std::string& state) {
  bool begun = true;
  Task& task = batch.tasks[index];
  task.over = true;
  for (Entry& entry : task.entries) {
    if (entry.ended) continue;
    if (entry.killed)
      end(entry, {.end = {.signal = SIGKILL}});
    else if (!begun || is_innocent(state))
      end(entry, {.preempted = true,
                  .why = begun && state != "COMPLETED" ? "taken from its machine (Slurm: " + state + ")" : ""});
    else
      end(entry, {.end = {.signal = SIGKILL}, .why = "lost by Slurm (" + state + ")"});
    begun = false;
  }
}

void SlurmExecutor::drop_finished() {
  for (auto batch = batches_.begin(); batch != batches_.end();) {
    for (Task& task : batch->tasks)
      task.over |=
          std::all_of(task.entries.begin(), task.entries.end(), [](const Entry& entry) { return entry.ended; });
    const bool over = std::all_of(batch->tasks.begin(), batch->tasks.end(), [](const Task& task) { return task.over; });
    if (!over || &*batch == submitting_) {
      ++batch;
      continue;
    }
    std::error_code ignored;
    fs::remove_all(batch->directory.path(), ignored);
    batch = batches_.erase(batch);
  }
}

// Array jobs that an earlier process submitted and that went on without it.

void SlurmExecutor::recover() {
  std::error_code error;
  fs::create_directories(directory_, error);
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(directory_, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory()) left.push_back(entry->path());
  if (error) throw_io_error("read", directory_, error.value());
  std::sort(left.begin(), left.end());
  for (const fs::path& path : left) recover(path);
}

void SlurmExecutor::recover(const fs::path& path) {
  Batch& batch = batches_.emplace_back(Batch{.directory = BatchDirectory(path), .since = recovered_});
  batch.job = batch.directory.job();
  try {
    for (std::size_t i = 0;; ++i) {
      const std::optional<std::vector<Run>> runs = batch.directory.runs(i);
      if (!runs) break;
      Task& task = batch.tasks.emplace_back();
      for (const Run& run : *runs) task.entries.push_back({.run = run});
    }
  } catch (const IoError& e) {  // its tasks cannot read it either
    note_(e.what());
    batch.tasks.clear();
    return;
  }
  collect(batch);
  for (std::size_t i = 0; i < batch.tasks.size(); ++i)
    for (std::size_t p = 0; p < batch.tasks[i].entries.size(); ++p)
      if (const Entry& entry = batch.tasks[i].entries[p]; !entry.ended) unclaimed_[entry.run.name] = {&batch, {i, p}};
}

/// Whether an earlier process handed the run to Slurm; the run is then adopted.
bool SlurmExecutor::take_over(const Run& run, RunId id) {
  const auto at = unclaimed_.find(run.name);
  if (at == unclaimed_.end()) return false;
  const Place place = at->second;
  unclaimed_.erase(at);
  entry(place).id = id;
  open_[id] = place;
  return true;
}

/// Runs that no study has adopted by now are dropped.
void SlurmExecutor::drop_unclaimed() {
  if (unclaimed_.empty() || Steady::now() - recovered_ < patience || !has_room()) return;
  for (const auto& [name, place] : unclaimed_) {
    entry(place).killed = true;
    Task& task = place.batch->tasks[place.run.task];
    task.unwanted =
        std::none_of(task.entries.begin(), task.entries.end(), [](const Entry& e) { return e.id != 0 && !e.ended; });
  }
  unclaimed_.clear();
}

}  // namespace talus::executor

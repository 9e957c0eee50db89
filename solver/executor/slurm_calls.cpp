// sbatch, squeue and scancel: called in the background, their output checked.

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <random>
#include <utility>

#include "executor/slurm.hpp"
#include "support/files.hpp"

namespace talus::executor {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds most_patience{120};  ///< maximum duration of one call
constexpr std::size_t max_answer = std::size_t{1} << 30;
constexpr int most_refusals = 3;
constexpr std::size_t most_tasks = 1000;  ///< of an array job; Slurm's own default allows 1001
constexpr std::size_t most_runs = 5000;   ///< of an array job, so that its directory stays quick to read

/// The environment variables that Slurm's programs, and through them the runs, inherit.
std::vector<std::string> environment() {
  constexpr std::array exact{"PATH",   "HOME", "USER",       "LOGNAME",         "LANG",
                             "LC_ALL", "TZ",   "SLURM_CONF", "LD_LIBRARY_PATH", "TALUS_SIMD"};
  std::vector<std::string> all;
  for (char** variable = environ; *variable; ++variable) {
    const std::string text = *variable, name = text.substr(0, text.find('='));
    const bool wanted = name.starts_with("OMP_") || name.ends_with("SAN_OPTIONS") ||
                        std::find(exact.begin(), exact.end(), name) != exact.end();
    if (wanted) all.push_back(text);
  }
  return all;
}

/// A unique name; names sort by time.
std::string batch_name() {
  static int counter = 0;
  std::random_device entropy;
  char text[64];
  std::snprintf(text, sizeof text, "%012llx-%04x-%08x", static_cast<unsigned long long>(std::time(nullptr)),
                counter++ & 0xffff, entropy());
  return text;
}

}  // namespace

SlurmExecutor::Call SlurmExecutor::call(std::vector<std::string> arguments) const {
  const fs::path out = directory_ / (arguments.front() + ".out"), err = directory_ / (arguments.front() + ".err");
  return {.process = Process({.arguments = std::move(arguments), .environment = environment()}, out, err),
          .out = out,
          .err = err,
          .begin = Steady::now()};
}

void SlurmExecutor::end_calls() {
  const auto end_of = [](std::optional<Call>& call) -> std::optional<ProcessEnd> {
    if (!call) return std::nullopt;
    const auto end = call->process.poll();
    if (!end && Steady::now() - call->begin > most_patience) call->process.signal(SIGKILL);
    return end;
  };
  if (const auto end = end_of(scancel_)) scancel_.reset();
  if (const auto end = end_of(squeue_)) {
    queue_seen(*squeue_, *end);
    squeue_.reset();
  }
  if (const auto end = end_of(sbatch_)) {
    const Call answered = *std::move(sbatch_);
    sbatch_.reset();
    submitted(answered, *end);
  }
}

/// The output of a program that succeeded. @throws IoError with its last line on stderr otherwise
std::string SlurmExecutor::answer(const Call& call, const ProcessEnd& end) {
  if (end.signal == 0 && end.exit_code == 0) return read_file(call.out, max_answer);
  std::string why = last_line(tail(call.err, 4000));
  if (why.empty())
    why = end.signal ? "killed: " + signal_text(end.signal) : "exit code " + std::to_string(end.exit_code);
  throw IoError(call.out.stem().string() + ": " + why);
}

void SlurmExecutor::queue_seen(const Call& call, const ProcessEnd& end) try {
  queue_.emplace(answer(call, end));
  queue_begun_ = call.begin;
  next_cycle_ = {};
  answered_since_ = true;
  if (std::exchange(away_, false)) note_("Slurm answers again");
} catch (const IoError& e) {
  if (!std::exchange(away_, true)) note_(std::string(e.what()) + "; waiting for Slurm");
}

/// sbatch has come back.
void SlurmExecutor::submitted(const Call& call, const ProcessEnd& end) {
  Batch& batch = *submitting_;
  try {
    batch.job = parse_job_id(answer(call, end));
  } catch (const IoError& e) {
    return not_submitted(e.what());
  }
  batch.since = Steady::now();
  submitting_ = nullptr;
  refusals_ = 0;
  batch.directory.write_job(*batch.job);
}

/// Removes the directory first: if Slurm did accept the job, its tasks find nothing to do.
void SlurmExecutor::not_submitted(const std::string& why) {
  std::error_code ignored;
  fs::remove_all(submitting_->directory.path(), ignored);
  for (auto task = submitting_->tasks.rbegin(); task != submitting_->tasks.rend(); ++task)
    for (auto entry = task->entries.rbegin(); entry != task->entries.rend(); ++entry) {
      open_.erase(entry->id);
      if (entry->killed)
        ended_.push_back({.id = entry->id, .end = {.signal = SIGKILL}});
      else if (stopping_)
        ended_.push_back({.id = entry->id, .preempted = true});
      else
        waiting_.push_front(std::move(*entry));
    }
  batches_.remove_if([&](const Batch& batch) { return &batch == submitting_; });
  submitting_ = nullptr;
  next_submit_ = Steady::now() + 3 * poll_;
  if (++refusals_ == 1) {
    note_(why + "; trying again");
    answered_since_ = false;
  }
  if (refusals_ < most_refusals || !answered_since_ || open_tasks() > 0) return;
  refusals_ = 0;
  throw IoError("Slurm takes no runs: " + why);
}

/// Takes waiting runs in order. A task has runs of one group only, since runs of different groups differ in duration.
std::vector<std::vector<SlurmExecutor::Entry>> SlurmExecutor::next_tasks(std::size_t free) {
  std::map<std::string, std::size_t> waits;
  for (const Entry& entry : waiting_) ++waits[entry.run.group];
  std::map<std::string, std::size_t> size;
  const double task_s = std::min(config_.task_s, 30.0 * config_.time_limit_min);
  for (const auto& [group, runs] : waits) size[group] = chunk_size(runs, free, times_.of(group), task_s);

  std::vector<std::vector<Entry>> tasks;
  std::map<std::string, std::size_t> filling;  // the task that takes the group's next run
  for (std::size_t taken = 0; !waiting_.empty() && taken < most_runs; ++taken) {
    const std::string group = waiting_.front().run.group;
    const auto at = filling.find(group);
    if (at == filling.end() || tasks[at->second].size() >= size[group]) {
      if (tasks.size() == std::min(free, most_tasks)) break;
      filling[group] = tasks.size();
      tasks.emplace_back();
    }
    tasks[filling[group]].push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  return tasks;
}

std::vector<std::string> SlurmExecutor::sbatch_arguments(const BatchDirectory& batch, std::size_t tasks) const {
  const int margin_s = std::min(60, 20 * config_.time_limit_min);  // for a checkpoint
  std::vector<std::string> all{
      "sbatch",
      "--parsable",
      "--array=0-" + std::to_string(tasks - 1),
      "--job-name=talus-" + batch.path().filename().string(),
      "--chdir=" + batch.path().string(),
      "--output=%a.log",
      "--open-mode=append",
      "--requeue",
      "--signal=B:TERM@" + std::to_string(margin_s),
      "--time=" + std::to_string(config_.time_limit_min),
      "--nodes=1",
      "--ntasks=1",
      "--cpus-per-task=" + std::to_string(config_.cpus_per_task > 0 ? config_.cpus_per_task : threads_)};
  if (!config_.partition.empty()) all.push_back("--partition=" + config_.partition);
  if (!config_.account.empty()) all.push_back("--account=" + config_.account);
  if (config_.memory_MiB > 0) all.push_back("--mem=" + std::to_string(config_.memory_MiB) + "M");
  all.insert(all.end(), config_.sbatch_options.begin(), config_.sbatch_options.end());
  all.push_back(batch.script().string());
  all.insert(all.end(), array_task_.begin(), array_task_.end());
  all.push_back(batch.path().string());
  return all;
}

void SlurmExecutor::submit() {
  const std::size_t open = open_tasks(), most = static_cast<std::size_t>(config_.array_tasks);
  if (sbatch_ || stopping_ || waiting_.empty() || Steady::now() < next_submit_ || open >= most) return;
  Batch& batch = batches_.emplace_back(Batch{.directory = BatchDirectory(directory_ / batch_name())});
  submitting_ = &batch;
  std::vector<std::vector<Run>> runs;
  for (std::vector<Entry>& entries : next_tasks(most - open)) {
    std::vector<Run>& task = runs.emplace_back();
    for (const Entry& entry : entries) {
      task.push_back(entry.run);
      open_[entry.id] = {&batch, {runs.size() - 1, task.size() - 1}};
    }
    batch.tasks.push_back({.entries = std::move(entries)});
  }
  try {
    batch.directory.write(runs);
    sbatch_.emplace(call(sbatch_arguments(batch.directory, runs.size())));
  } catch (const IoError& e) {
    not_submitted(e.what());
  }
  next_submit_ = std::max(next_submit_, Steady::now() + poll_);
}

void SlurmExecutor::ask_queue() {
  const bool waits = !batches_.empty() || refusals_ > 0;
  if (squeue_ || queue_ || !waits || Steady::now() < next_queue_) return;
  next_queue_ = Steady::now() + (away_ ? 3 * poll_ : poll_);
  squeue_.emplace(call({"squeue", "--json", "--states=all"}));  // newer ones leave out what has ended
}

/// Repeated until the tasks are gone, since the controller may have been unavailable.
void SlurmExecutor::cancel_unwanted() {
  if (scancel_ || Steady::now() < next_cancel_) return;
  std::vector<std::string> arguments{"scancel"};
  for (const Batch& batch : batches_)
    for (std::size_t i = 0; batch.job && i < batch.tasks.size(); ++i)
      if (batch.tasks[i].unwanted && !batch.tasks[i].over)
        arguments.push_back(std::to_string(*batch.job) + "_" + std::to_string(i));
  if (arguments.size() == 1) return;
  next_cancel_ = Steady::now() + 3 * poll_;
  scancel_.emplace(call(std::move(arguments)));
}

}  // namespace talus::executor

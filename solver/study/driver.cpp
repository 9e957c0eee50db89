#include "study/driver.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <deque>
#include <map>
#include <thread>

#include "executor/local.hpp"
#include "statistics/sample.hpp"
#include "study/ledger.hpp"
#include "study/publish.hpp"
#include "study/stop_rule.hpp"
#include "study/summary.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using executor::Ended;
using executor::Executor;

constexpr std::size_t tail_bytes = 4000;

/// A job and how often it has been tried.
struct Task {
  Job job;
  int attempts = 0;
};

struct Worker {
  Task task;
  bool unwanted = false;  ///< killed, since the study needs it no more
};

/// 1e-6 k in the shortest form that reads back.
std::string perturbation(std::int64_t k) { return to_text(static_cast<double>(k) / 1e6); }

std::unique_ptr<Executor> make_executor(const DriverOptions& options, const StudyPaths& paths) {
  if (options.make_executor) return options.make_executor(paths);
  return std::make_unique<executor::LocalExecutor>(options.workers);
}

class Driver {
 public:
  Driver(const Plan& plan, const fs::path& directory, const DriverOptions& options)
      : plan_(plan),
        options_(options),
        paths_{directory},
        ledger_(paths_, plan),
        executor_(make_executor(options, paths_)),
        last_(std::min(options.last.value_or(plan.study.realizations), plan.study.realizations)),
        next_(options.first) {}

  Outcome run();

 private:
  void wait_for_orphans();
  void adopt();
  std::optional<Outcome> verdict() const;
  std::optional<Task> take();
  void start(Task task);
  bool reap();
  void ended(Task task, const Ended& how);
  void broken_off(const Task& task, const Ended& how, const std::string& said);
  void again(const Task& task) { queue_.push_front(task); }
  void failed(const Task& task, const Ended& how, const std::string& reason);
  void drop_realizations();
  void stop_workers();
  bool idle() const { return workers_.empty(); }
  bool here(Job job) const {
    return job.floor ? options_.first == 0 : job.index >= options_.first && job.index < last_;
  }
  std::vector<std::string> arguments(Job job) const;
  void publish() const { write_tables(paths_, plan_, counted(plan_, ledger_.runs()), ledger_.floor()); }
  void report(bool now = false);
  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }
  int interrupts() const { return options_.interrupts ? options_.interrupts() : 0; }

  const Plan& plan_;
  const DriverOptions& options_;
  StudyPaths paths_;
  Ledger ledger_;
  std::unique_ptr<Executor> executor_;
  std::int64_t last_;
  std::int64_t next_;       ///< the first realization not looked at yet
  std::deque<Task> queue_;  ///< before those: what must be tried again, and the noise floor
  FileDescriptor orphan_lock_;
  std::map<executor::RunId, Worker> workers_;
  std::int64_t made_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point reported_ = begin_;
};

/// Workers inherit this lock and hold it as long as they live. When the study was killed its workers may live on for a
/// moment; two writers in one working directory would spoil it, so the next study waits here.
void Driver::wait_for_orphans() {
  const fs::path path = paths_.work() / "lock";
  orphan_lock_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT, 0666));  // no O_CLOEXEC: see above
  if (!orphan_lock_) throw_io_error("create", path, errno);
  const Clock::time_point begin = Clock::now();
  for (bool told = false; ::flock(orphan_lock_.get(), LOCK_EX | LOCK_NB) != 0;) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return;  // a file system without locks
    if (!told) note("waiting for workers of an earlier study here to end");
    told = true;
    if (interrupts() > 0) return;
    if (Clock::now() - begin > options_.grace)
      throw IoError("workers of an earlier study still run in " + paths_.root.string() + "; end them first");
    std::this_thread::sleep_for(options_.poll);
  }
}

/// Takes over what finished after the study that started it was killed.
void Driver::adopt() {
  std::vector<Job> left;
  for (const auto& entry : fs::directory_iterator(paths_.work())) {
    const std::string name = entry.path().filename().string();
    const bool floor = name.starts_with("floor-");
    const std::string digits = floor ? name.substr(6) : name;
    Job job{.floor = floor};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), job.index);
    if (entry.is_directory() && error == std::errc() && end == digits.data() + digits.size()) left.push_back(job);
  }
  for (const Job job : left) {
    if (ledger_.has(job) || !ledger_.finished_in_work(job)) continue;
    ledger_.commit(job);
    note(job_name(job) + " had finished before; taken over");
  }
}

/// The next job that is not in the books: retries, then realization 0, the noise floor, and the others in order.
std::optional<Task> Driver::take() {
  const bool origin_first = next_ == 0 && next_ < last_ && !ledger_.has({.index = 0});
  if (!queue_.empty() && !(origin_first && queue_.front().attempts == 0)) {
    const Task task = queue_.front();
    queue_.pop_front();
    return task;
  }
  while (next_ < last_) {
    const Job job{.index = next_++};
    if (!ledger_.has(job)) return Task{job};
  }
  return std::nullopt;
}

std::vector<std::string> Driver::arguments(Job job) const {
  std::vector<std::string> all = options_.program;
  all.insert(all.end(), {paths_.resolved_case().string(), "--realization", std::to_string(job.floor ? 0 : job.index),
                         "--seed", std::to_string(plan_.seed), "--threads", std::to_string(options_.threads), "--out",
                         paths_.work(job).string(), "--study-worker"});
  if (job.floor) all.insert(all.end(), {"--perturbation", perturbation(job.index)});
  return all;
}

void Driver::start(Task task) {
  ++task.attempts;
  const fs::path work = paths_.work(task.job);
  const executor::RunId id = executor_->start({.name = work.filename().string(),
                                               .group = plan_.case_hash,
                                               .command = {.arguments = arguments(task.job)},
                                               .directory = work,
                                               .log = paths_.log(task.job)});
  workers_.emplace(id, Worker{task});
}

void Driver::failed(const Task& task, const Ended& how, const std::string& reason) {
  const Job job = task.job;
  std::string rerun = "talus run " + paths_.resolved_case().string() + " --realization " +
                      std::to_string(job.floor ? 0 : job.index) + " --seed " + std::to_string(plan_.seed) +
                      (job.floor ? " --perturbation " + perturbation(job.index) : "") + " --out DIR";
  ledger_.commit_failure(job, {.reason = reason,
                               .exit_code = how.end.exit_code,
                               .signal = how.end.signal,
                               .attempts = task.attempts,
                               .log_tail = executor::tail(paths_.log(job), tail_bytes),
                               .rerun = std::move(rerun)});
  ++made_;
  note(job_name(job) + " failed: " + reason);
}

/// It came to no end of its own: once more, unless it has been tried often enough.
void Driver::broken_off(const Task& task, const Ended& how, const std::string& said) {
  std::string text = how.why;
  if (text.empty())
    text = how.end.signal ? "killed: " + executor::signal_text(how.end.signal)
                          : "stopped from outside (exit code " + std::to_string(how.end.exit_code) + ")";
  if (task.attempts >= options_.attempts)
    return failed(task, how, text + ", " + std::to_string(task.attempts) + " times" + said);
  note(job_name(task.job) + " was " + text + "; trying once more");
  again(task);
}

/// What the end of a worker means for its job. Throws where it means that the study cannot go on.
void Driver::ended(Task task, const Ended& how) {
  const Job job = task.job;
  if (how.taken) {
    if (!how.why.empty() && interrupts() == 0) note(job_name(job) + " was " + how.why + "; it goes on elsewhere");
    --task.attempts;
    return again(task);
  }
  const std::string log = executor::tail(paths_.log(job), tail_bytes);
  const std::string said = executor::last_line(log).empty() ? "" : ": " + executor::last_line(log);
  const auto code = static_cast<Exit>(how.end.exit_code);
  const bool asked = code == Exit::interrupted || code == Exit::sigint || code == Exit::sigterm;
  if (!how.end.signal && code == Exit::ok) {
    if (!ledger_.finished_in_work(job)) return failed(task, how, "it ended well but left no readable result" + said);
    ledger_.commit(job);
    ++made_;
  } else if (how.end.signal || asked) {
    if (interrupts() == 0) broken_off(task, how, said);  // else: asked to stop, it did
  } else if (code == Exit::io && how.resumed) {
    note(job_name(job) + " cannot go on from its checkpoint" + said + "; starting it again");
    remove_directory(paths_.work(job));
    again(task);
  } else if (code == Exit::io && executor_->survives_us() && task.attempts < options_.attempts) {
    note(job_name(job) + " cannot read or write" + said + "; trying once more, maybe on another machine");
    again(task);
  } else if (code == Exit::io) {
    throw IoError("the study stops, since " + job_name(job) + " cannot read or write" + said);
  } else if (code == Exit::usage || code == Exit::bad_case) {
    throw ConfigError("", "the study stops, since " + job_name(job) + " refuses the case:\n" + log);
  } else if (code == Exit::diverged) {
    failed(task, how, "diverged" + said);
  } else {
    failed(task, how, "exit code " + std::to_string(how.end.exit_code) + said);
  }
}

/// Handles every worker that has ended; true where there was one.
bool Driver::reap() {
  const std::vector<Ended> all = executor_->poll();
  for (const Ended& how : all) {
    const Worker worker = workers_.at(how.id);
    workers_.erase(how.id);
    if (!worker.unwanted) ended(worker.task, how);
  }
  return !all.empty();
}

/// A study that stops early still owes its noise floor, and nothing else.
void Driver::drop_realizations() {
  next_ = last_;
  std::erase_if(queue_, [](const Task& task) { return !task.job.floor; });
  for (auto& [id, worker] : workers_) {
    if (worker.task.job.floor || worker.unwanted) continue;
    worker.unwanted = true;
    executor_->kill(id);
  }
}

/// Asks all workers to end and gives them time; what finishes meanwhile counts. Local ones that do not are killed with
/// the executor; others are found again by the next study here.
void Driver::stop_workers() {
  executor_->stop_all();
  const Clock::time_point begin = Clock::now();
  while (!idle() && Clock::now() - begin < options_.grace && interrupts() < 2) {
    for (const Ended& how : executor_->poll()) {
      const Worker worker = workers_.at(how.id);
      workers_.erase(how.id);
      const bool well = !how.taken && !how.end.signal && how.end.exit_code == 0;
      if (well && !worker.unwanted && ledger_.finished_in_work(worker.task.job)) ledger_.commit(worker.task.job);
    }
    report();
    std::this_thread::sleep_for(options_.poll);
  }
}

/// Whether the books already decide how the study ends.
std::optional<Outcome> Driver::verdict() const {
  const auto failures = std::count_if(ledger_.runs().begin(), ledger_.runs().end(),
                                      [&](const Record& r) { return !r.done && here({.index = r.index}); });
  if (static_cast<double>(failures) > plan_.study.max_failed_share * static_cast<double>(last_ - options_.first))
    return Outcome::too_many_failed;
  const auto stop = stopping_size(plan_, ledger_.runs());
  if (stop && *stop < last_) return Outcome::stopped_early;
  return std::nullopt;
}

void Driver::report(bool now) {
  if (!options_.report || (!now && Clock::now() - reported_ < std::chrono::milliseconds(200))) return;
  reported_ = Clock::now();
  Progress p{.planned = last_ - options_.first, .made_now = made_, .running = static_cast<int>(workers_.size())};
  std::vector<double> zones;
  for (const Record& r : ledger_.runs()) {
    if (!here({.index = r.index})) continue;
    ++(r.done ? p.done : p.failed);
    if (r.done) zones.push_back(r.measures.influence_zone);
  }
  const SampleMoments m = moments(zones);
  p.mean = m.mean;
  p.mean_half_width = mean_half_width(m);
  p.floor_planned = here({.floor = true}) ? plan_.study.noise_floor_replicates : 0;
  p.floor_made = std::min<std::int64_t>(p.floor_planned, std::ssize(ledger_.floor()));
  p.waits = executor_->waits(plan_.case_hash);
  p.elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  options_.report(p);
}

Outcome Driver::run() {
  ledger_.make_directories();
  wait_for_orphans();
  if (options_.retry_failed) ledger_.forget_failures();
  adopt();
  for (std::int64_t k = 1; here({.floor = true}) && k <= plan_.study.noise_floor_replicates; ++k)
    if (!ledger_.has({true, k})) queue_.push_back({{true, k}});

  std::optional<Outcome> outcome = verdict();
  Clock::time_point publish_at = Clock::now() + options_.publish_every;
  try {
    while (interrupts() == 0 && outcome != Outcome::too_many_failed) {
      if (outcome == Outcome::stopped_early) drop_realizations();
      while (executor_->has_room()) {
        const std::optional<Task> task = take();
        if (!task) break;
        start(*task);
      }
      if (idle()) break;
      report();
      std::this_thread::sleep_for(options_.poll);
      if (!reap()) continue;
      outcome = verdict();
      const Clock::time_point begin = Clock::now();
      if (begin < publish_at) continue;
      publish();
      // A long table takes its time; no more than a twentieth of ours.
      publish_at = Clock::now() + std::max<Clock::duration>(options_.publish_every, 20 * (Clock::now() - begin));
    }
    if (!idle()) stop_workers();
  } catch (...) {
    stop_workers();
    throw;
  }
  publish();
  report(true);
  if (interrupts() > 0) return Outcome::interrupted;
  if (outcome == Outcome::too_many_failed) return Outcome::too_many_failed;
  executor_.reset();
  orphan_lock_.close();  // what is open cannot be removed on every file system
  remove_directory(paths_.work());
  if (too_many_failed(plan_, counted(plan_, ledger_.runs()))) return Outcome::too_many_failed;
  return outcome.value_or(Outcome::finished);
}

/// The case as the workers read it: written once, and again only when it has changed (more realizations).
void write_resolved(const fs::path& path, const nlohmann::ordered_json& resolved) {
  const std::string text = resolved.dump(2) + "\n";
  if (fs::exists(path) && read_file(path, std::size_t{1} << 30) == text) return;
  write_file_atomically(path, text);
}

/// The directory as its owner, with plan and case written.
OutputDirectory claim(const Plan& plan, const nlohmann::ordered_json& resolved, const fs::path& directory) {
  if (const auto begun = find_plan(directory)) check_continues(*begun, plan, directory);
  const StudyPaths paths{directory};
  if (fs::exists(paths.realizations()) && !fs::exists(paths.runs()))
    throw IoError(directory.string() +
                  " holds a merged study, which cannot go on; run the rest elsewhere and merge again");
  OutputDirectory claimed(directory, OutputKind::study, plan.case_hash, true);
  write_resolved(paths.resolved_case(), resolved);
  write_plan(directory, plan);
  return claimed;
}

}  // namespace

void prepare_study(const Plan& plan, const nlohmann::ordered_json& resolved, const fs::path& directory) {
  claim(plan, resolved, directory);
}

Outcome run_study(const Plan& plan, const nlohmann::ordered_json& resolved, const fs::path& directory,
                  const DriverOptions& options) {
  OutputDirectory claimed = claim(plan, resolved, directory);
  try {
    const Outcome outcome = Driver(plan, directory, options).run();
    if (outcome == Outcome::finished || outcome == Outcome::stopped_early) claimed.mark_finished();
    return outcome;
  } catch (const executor::ProcessError& e) {
    throw IoError(e.what());
  } catch (const fs::filesystem_error& e) {
    throw_io_error("write", e.path1().empty() ? directory : e.path1(), e.code().value());
  }
}

}  // namespace talus

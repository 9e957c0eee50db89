#include "study/driver.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <deque>
#include <list>
#include <thread>

#include "io/files.hpp"
#include "monte_carlo/statistics.hpp"
#include "study/ledger.hpp"
#include "study/process.hpp"
#include "study/publish.hpp"
#include "study/stop_rule.hpp"
#include "study/summary.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int most_attempts = 2;
constexpr std::size_t tail_bytes = 4000;
constexpr const char* checkpoint_name = "checkpoint.h5";

/// A job and how often it has been tried.
struct Task {
  Job job;
  int attempts = 0;
};

struct Worker {
  Task task;
  bool resumed = false;
  Process process;
};

/// 1e-6 k in the shortest form that reads back.
std::string perturbation(std::int64_t k) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, static_cast<double>(k) / 1e6).ptr};
}

/// The last line that says something.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
  const std::size_t start = text.find_last_of('\n');
  return start == std::string::npos ? text : text.substr(start + 1);
}

class Driver {
 public:
  Driver(const Plan& plan, const fs::path& directory, const DriverOptions& options)
      : plan_(plan),
        options_(options),
        paths_{directory},
        ledger_(paths_, plan),
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
  void ended(Worker& worker, ProcessEnd end);
  void failed(const Worker& worker, ProcessEnd end, const std::string& reason);
  void stop_workers(bool checkpoint);
  bool idle() const { return workers_.empty(); }
  bool here(Job job) const {
    return job.floor ? options_.first == 0 : job.index >= options_.first && job.index < last_;
  }
  std::vector<std::string> arguments(Job job, bool resume) const;
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
  std::int64_t last_;
  std::int64_t next_;       ///< the first realization not looked at yet
  std::deque<Task> queue_;  ///< before those: what must be tried again, and the noise floor
  std::list<Worker> workers_;
  FileDescriptor orphan_lock_;
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

std::vector<std::string> Driver::arguments(Job job, bool resume) const {
  std::vector<std::string> all = options_.program;
  all.insert(all.end(), {paths_.resolved_case().string(), "--realization", std::to_string(job.floor ? 0 : job.index),
                         "--seed", std::to_string(plan_.seed), "--threads", std::to_string(options_.threads), "--out",
                         paths_.work(job).string(), "--study-worker"});
  if (job.floor) all.insert(all.end(), {"--perturbation", perturbation(job.index)});
  if (resume) all.emplace_back("--resume");
  return all;
}

void Driver::start(Task task) {
  const fs::path work = paths_.work(task.job);
  const bool resume = fs::exists(work / checkpoint_name);
  if (!resume) fs::remove_all(work);
  fs::remove(paths_.log(task.job));
  ++task.attempts;
  workers_.push_back({task, resume, Process(arguments(task.job, resume), paths_.log(task.job))});
}

void Driver::failed(const Worker& worker, ProcessEnd end, const std::string& reason) {
  const Job job = worker.task.job;
  std::string rerun = "talus run " + paths_.resolved_case().string() + " --realization " +
                      std::to_string(job.floor ? 0 : job.index) + " --seed " + std::to_string(plan_.seed) +
                      (job.floor ? " --perturbation " + perturbation(job.index) : "") + " --out DIR";
  ledger_.commit_failure(job, {.reason = reason,
                               .exit_code = end.exit_code,
                               .signal = end.signal,
                               .attempts = worker.task.attempts,
                               .log_tail = tail(paths_.log(job), tail_bytes),
                               .rerun = std::move(rerun)});
  ++made_;
  note(job_name(job) + " failed: " + reason);
}

/// What the end of a worker means for its job. Throws where it means that the study cannot go on.
void Driver::ended(Worker& worker, ProcessEnd end) {
  const Job job = worker.task.job;
  const std::string log = tail(paths_.log(job), tail_bytes);
  const std::string said = last_line(log).empty() ? "" : ": " + last_line(log);
  const auto code = static_cast<Exit>(end.exit_code);
  const bool broken_off = end.signal != 0 || code == Exit::interrupted || code == Exit::sigint || code == Exit::sigterm;
  if (!end.signal && code == Exit::ok) {
    if (!ledger_.finished_in_work(job)) return failed(worker, end, "it ended well but left no readable result" + said);
    ledger_.commit(job);
    ++made_;
  } else if (broken_off && interrupts() > 0) {
    return;  // asked to stop, it did
  } else if (broken_off) {
    const std::string how = end.signal ? "killed: " + signal_text(end.signal)
                                       : "stopped from outside (exit code " + std::to_string(end.exit_code) + ")";
    if (worker.task.attempts >= most_attempts)
      return failed(worker, end, how + ", " + std::to_string(worker.task.attempts) + " times" + said);
    note(job_name(job) + " was " + how + "; trying once more");
    queue_.push_front(worker.task);
  } else if (code == Exit::io && worker.resumed) {
    note(job_name(job) + " cannot go on from its checkpoint" + said + "; starting it again");
    fs::remove_all(paths_.work(job));
    queue_.push_front(worker.task);
  } else if (code == Exit::io) {
    throw IoError("the study stops, since " + job_name(job) + " cannot read or write" + said);
  } else if (code == Exit::usage || code == Exit::bad_case) {
    throw ConfigError("", "the study stops, since " + job_name(job) + " refuses the case:\n" + log);
  } else if (code == Exit::diverged) {
    failed(worker, end, "diverged" + said);
  } else {
    failed(worker, end, "exit code " + std::to_string(end.exit_code) + said);
  }
}

/// Handles every worker that has ended; true where there was one.
bool Driver::reap() {
  bool any = false;
  for (auto worker = workers_.begin(); worker != workers_.end();) {
    const std::optional<ProcessEnd> end = worker->process.poll();
    if (!end) {
      ++worker;
      continue;
    }
    any = true;
    ended(*worker, *end);
    worker = workers_.erase(worker);
  }
  return any;
}

/// Ends all workers. With `checkpoint` they are asked first and given time; what finishes meanwhile counts.
void Driver::stop_workers(bool checkpoint) {
  if (checkpoint) {
    for (const Worker& worker : workers_) worker.process.signal(SIGTERM);
    const Clock::time_point begin = Clock::now();
    while (!idle() && Clock::now() - begin < options_.grace && interrupts() < 2) {
      for (auto worker = workers_.begin(); worker != workers_.end();) {
        const std::optional<ProcessEnd> end = worker->process.poll();
        if (end && !end->signal && end->exit_code == 0 && ledger_.finished_in_work(worker->task.job))
          ledger_.commit(worker->task.job);
        worker = end ? workers_.erase(worker) : std::next(worker);
      }
      report();
      std::this_thread::sleep_for(options_.poll);
    }
  }
  workers_.clear();  // kills what is left
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
  p.elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  options_.report(p);
}

Outcome Driver::run() {
  wait_for_orphans();
  if (options_.retry_failed) ledger_.forget_failures();
  adopt();
  for (std::int64_t k = 1; here({.floor = true}) && k <= plan_.study.noise_floor_replicates; ++k)
    if (!ledger_.has({true, k})) queue_.push_back({{true, k}});

  std::optional<Outcome> outcome = verdict();
  Clock::time_point published = Clock::now();
  try {
    while (interrupts() == 0 && outcome != Outcome::too_many_failed) {
      // A study that stops early still owes its noise floor.
      if (outcome == Outcome::stopped_early) {
        next_ = last_;
        std::erase_if(queue_, [](const Task& task) { return !task.job.floor; });
        workers_.remove_if([](const Worker& worker) { return !worker.task.job.floor; });
      }
      while (static_cast<int>(workers_.size()) < options_.workers) {
        const std::optional<Task> task = take();
        if (!task) break;
        start(*task);
      }
      if (idle()) break;
      report();
      std::this_thread::sleep_for(options_.poll);
      if (!reap()) continue;
      outcome = verdict();
      if (Clock::now() - published < options_.publish_every) continue;
      publish();
      published = Clock::now();
    }
    if (!idle()) stop_workers(true);
  } catch (...) {
    stop_workers(true);
    throw;
  }
  publish();
  report(true);
  if (interrupts() > 0) return Outcome::interrupted;
  if (outcome == Outcome::too_many_failed) return Outcome::too_many_failed;
  fs::remove_all(paths_.work());
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
  } catch (const fs::filesystem_error& e) {
    throw_io_error("write", e.path1().empty() ? directory : e.path1(), e.code().value());
  }
}

}  // namespace talus

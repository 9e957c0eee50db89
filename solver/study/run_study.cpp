#include "study/run_study.hpp"

#include <thread>

#include "study/directory_store.hpp"
#include "study/engine.hpp"
#include "study/publish.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::unique_ptr<executor::Executor> make_executor(const RunStudyOptions& options, const StudyPaths& paths) {
  if (options.make_executor) return options.make_executor(paths);
  return executor::make_local_executor(options.workers);
}

/// Runs a study that has been claimed: the engine with a directory, a progress report, tables now and then.
class StudyRunner {
 public:
  StudyRunner(const Plan& plan, const fs::path& directory, const RunStudyOptions& options)
      : plan_(plan),
        options_(options),
        paths_{directory},
        store_(paths_, plan, options.first,
               std::min(options.last.value_or(plan.study.realizations), plan.study.realizations)),
        executor_(make_executor(options, paths_)) {}

  StudyEnd run();

 private:
  void wait_for_earlier_workers();
  EngineOptions engine_options();
  void run_all(Engine& engine);
  void stop_runs(Engine& engine);
  void publish();
  void report(Engine& engine, bool now = false);
  void note_event(const RunEvent& event);
  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }
  int interrupts() const { return options_.interrupts ? options_.interrupts() : 0; }

  const Plan& plan_;
  const RunStudyOptions& options_;
  StudyPaths paths_;
  DirectoryStore store_;
  std::unique_ptr<executor::Executor> executor_;
  FileDescriptor workers_lock_;
  std::int64_t made_ = 0, run_again_ = 0;
  std::optional<ControlledMean> regression_;  ///< of the leading measure when tables were last written
  Clock::time_point begin_ = Clock::now(), reported_ = begin_;
};

/// Workers inherit this lock and hold it as long as they live. When a study is killed its workers may live on for a
/// moment; two writers in one working directory would spoil it, so the next study waits here. On a file system without
/// locks the study goes on: local workers die with their study, results appear by rename, and a run gives the same
/// result whoever carries it out.
void StudyRunner::wait_for_earlier_workers() {
  fs::create_directories(paths_.work());
  const Clock::time_point begin = Clock::now();
  for (bool told = false;; told = true) {
    TriedLock lock = try_lock(paths_.work() / "lock", true);
    if (!lock.supported) note("the file system has no locks: do not start a second study in " + paths_.root.string());
    workers_lock_ = std::move(lock.file);
    if (workers_lock_) return;
    if (!told) note("waiting for workers of an earlier study here to end");
    if (interrupts() > 0) return;
    if (Clock::now() - begin > options_.grace)
      throw IoError("workers of an earlier study still run in " + paths_.root.string() + "; end them first");
    std::this_thread::sleep_for(options_.poll);
  }
}

void StudyRunner::publish() {
  const auto source = [this](RunKind kind) {
    return [this, kind](const RecordSink& take) {
      for (const auto& [index, record] : std::as_const(store_).records(kind)) take(record);
    };
  };
  const StudySummary summary = talus::publish(paths_, plan_, source(RunKind::realization), source(RunKind::replicate));
  if (const RegressionSummary of = summary.regression(leading_measure); of.done()) regression_ = of.mean;
}

void StudyRunner::note_event(const RunEvent& event) {
  const std::string name = run_name(event.claim.key);
  using Kind = RunEvent::Kind;
  switch (event.kind) {
    case Kind::done:
      ++made_;
      return;
    case Kind::failed:
      ++made_;
      return note(name + " failed: " + event.reason);
    case Kind::taken_over:
      return note(name + " had finished before; taken over");
    case Kind::crashed:
      ++run_again_;
      return note(name + ": " + event.reason + "; running it again");
    case Kind::given_back:
      if (!event.reason.empty() && interrupts() == 0) note(name + ": " + event.reason + "; running it again");
      return;
    case Kind::stale:
      return;
  }
}

EngineOptions StudyRunner::engine_options() {
  return {.attempts = options_.attempts,
          .command =
              [this](const StudyInfo& study, const RunKey& key) {
                return executor::Command{
                    .arguments = run_arguments(options_.program, study, key, options_.threads),
                    .limits = {.wall_seconds = options_.time_limit_s, .stall_seconds = options_.stall_limit_s}};
              },
          .room_on_disk = {},
          .report = [this](const RunEvent& event) { note_event(event); }};
}

/// Asks all workers to end and gives them time; what finishes meanwhile counts. Local ones that do not are killed with
/// the executor; others are found again by the next study here.
void StudyRunner::stop_runs(Engine& engine) {
  engine.stop();
  const Clock::time_point begin = Clock::now();
  while (engine.running() > 0 && Clock::now() - begin < options_.grace && interrupts() < 2) {
    engine.record_ended();
    report(engine);
    std::this_thread::sleep_for(options_.poll);
  }
}

void StudyRunner::report(Engine& engine, bool now) {
  if (!options_.report || (!now && Clock::now() - reported_ < std::chrono::milliseconds(200))) return;
  reported_ = Clock::now();
  const Estimator& estimator = engine.estimator(0);
  options_.report({.planned = estimator.planned(),
                   .done = estimator.done(),
                   .failed = estimator.failed(),
                   .floor_planned = options_.first == 0 ? plan_.study.noise_floor_replicates : 0,
                   .floor_made = options_.first == 0 ? estimator.replicates_made() : 0,
                   .made_now = made_,
                   .run_again = run_again_,
                   .running = static_cast<int>(engine.running()),
                   .elapsed = std::chrono::duration<double>(Clock::now() - begin_).count(),
                   .mean = estimator.mean(),
                   .mean_half_width = estimator.mean_half_width(),
                   .leading_mean = regression_,
                   .pending_reason = engine.executor().pending_reason(plan_.of.hash)});
}

void StudyRunner::run_all(Engine& engine) {
  Clock::time_point publish_at = Clock::now() + options_.publish_every;
  while (interrupts() == 0) {
    engine.start_runs();
    if (engine.running() == 0) return;
    report(engine);
    std::this_thread::sleep_for(options_.poll);
    if (!engine.record_ended()) continue;
    const Clock::time_point begin = Clock::now();
    if (begin < publish_at) continue;
    publish();
    // Writing long tables takes at most a twentieth of the time.
    publish_at = Clock::now() + std::max<Clock::duration>(options_.publish_every, 20 * (Clock::now() - begin));
  }
}

StudyEnd StudyRunner::run() {
  wait_for_earlier_workers();
  if (options_.retry_failed) store_.forget_failures();
  for (const std::int64_t index : store_.forget_damaged_profiles())
    note("the kept profile of realization " + std::to_string(index) + " is damaged; running it again");
  Engine engine(store_, std::move(executor_), engine_options());
  engine.estimator(0);  // makes the directories, and applies what the records decide
  try {
    run_all(engine);
    if (engine.running() > 0) stop_runs(engine);
  } catch (...) {
    try {
      stop_runs(engine);
    } catch (const std::exception&) {  // the first error is the one to report
    }
    throw;
  }
  publish();
  report(engine, true);
  if (interrupts() > 0) return StudyEnd::interrupted;
  const Estimator::Decision decision = engine.estimator(0).decision();
  if (decision == Estimator::Decision::too_many_failed) return StudyEnd::too_many_failed;
  engine.close();
  workers_lock_.close();  // what is open cannot be removed on every file system
  remove_directory(paths_.work());
  return decision == Estimator::Decision::enough ? StudyEnd::stopped_early : StudyEnd::finished;
}

/// The case as the workers read it: written once, and again only when it has changed (more realizations).
void write_resolved(const fs::path& path, const nlohmann::ordered_json& resolved) {
  const std::string text = resolved.dump(2) + "\n";
  if (find_file(path, std::size_t{1} << 30) != text) write_file_atomically(path, text);
}

/// The directory as its owner, with plan and case written.
/// @param plan  is given the earlier ends of a study that is continued
OutputDirectory claim_directory(Plan& plan, const nlohmann::ordered_json& resolved, const fs::path& directory,
                                bool resume) {
  if (const auto begun = find_plan(directory)) {
    check_continues(*begun, plan, directory, resume);
    plan.earlier = begun->earlier;
    if (plan.of.extends(begun->of)) plan.earlier.push_back(begun->of.hash);
  }
  const StudyPaths paths{directory};
  if (fs::exists(paths.realizations()) && !fs::exists(paths.runs()))
    throw IoError(directory.string() +
                  " holds a merged study, which cannot go on; run the rest elsewhere and merge again");
  OutputDirectory claimed(directory, OutputKind::study, plan.of, true);
  write_plan(directory, plan);  // first: it says which results of earlier ends belong to the study
  write_resolved(paths.resolved_case(), resolved);
  if (claimed.extends()) claimed.reopen();
  return claimed;
}

}  // namespace

void prepare_study(const Plan& plan, const nlohmann::ordered_json& resolved, const fs::path& directory) {
  Plan claimed = plan;
  claim_directory(claimed, resolved, directory, false);
}

StudyEnd run_study(const Plan& asked, const nlohmann::ordered_json& resolved, const fs::path& directory,
                   const RunStudyOptions& options) {
  Plan plan = asked;
  OutputDirectory claimed = claim_directory(plan, resolved, directory, options.resume);
  try {
    const StudyEnd end = StudyRunner(plan, directory, options).run();
    if (end == StudyEnd::finished || end == StudyEnd::stopped_early) claimed.mark_finished();
    return end;
  } catch (const fs::filesystem_error& e) {
    throw_io_error("write", e.path1().empty() ? directory : e.path1(), e.code().value());
  }
}

}  // namespace talus

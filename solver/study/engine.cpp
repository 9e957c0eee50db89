#include "study/engine.hpp"

#include "support/files.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using Action = Outcome::Action;
using Kind = RunEvent::Kind;

constexpr std::size_t tail_bytes = 4000;

void make_directories(const StudyPaths& paths) {
  for (const fs::path& directory : {paths.runs(), paths.floor(), paths.work(), paths.profiles()})
    fs::create_directories(directory);
}

}  // namespace

Engine::Engine(Store& store, std::unique_ptr<executor::Executor> executor, EngineOptions options)
    : store_(store), executor_(std::move(executor)), options_(std::move(options)) {}

Engine::Study& Engine::open(StudyNumber number) {
  if (const auto known = studies_.find(number); known != studies_.end() && !known->second.stale) return known->second;
  StudyInfo info = store_.study(number);
  Estimator estimator(info.spec, info.first, info.end);
  store_.visit_records(number, [&](const RunKey& key, std::optional<double> zone) { estimator.add(key, zone); });
  if (fs::exists(info.paths.resolved_case())) make_directories(info.paths);  // otherwise stop_where_lost() says so
  const auto [study, fresh] = studies_.insert_or_assign(number, Study{std::move(info), std::move(estimator)});
  apply_decision(number);
  return study->second;
}

void Engine::forget(StudyNumber number) {
  const auto known = studies_.find(number);
  if (known == studies_.end()) return;
  known->second.stale = true;
  if (!studies_running().contains(number)) studies_.erase(known);
}

std::set<StudyNumber> Engine::studies_running() const {
  std::set<StudyNumber> all;
  for (const auto& [id, run] : runs_) all.insert(run.claim.study);
  return all;
}

void Engine::start_runs() {
  while (!stopping_ && executor_->has_room()) {
    if (!room_on_disk()) throw IoError("the disk is nearly full: no run is started until there is room");
    const std::optional<Claim> claim = store_.claim();
    if (!claim) return;
    try {
      start(*claim);
    } catch (...) {
      store_.give_back(*claim, false);
      throw;
    }
  }
}

void Engine::start(const Claim& claim) {
  const Study& study = open(claim.study);
  if (!store_.is_current(claim)) return;  // the records already decide how the study ends
  if (stop_where_lost(study.info, claim.study) || take_over(claim)) return;
  const fs::path work = study.info.paths.work(claim.key);
  const std::string prefix = study.info.name.empty() ? "" : study.info.name + "/";
  executor::Command command = options_.command(study.info, claim.key);
  const std::uint64_t time_limit_s = command.limits.wall_seconds;
  const executor::RunId id =
      executor_->start({.name = prefix + work.filename().string(),
                        .group = study.info.name.empty() ? study.info.identity.case_hash : study.info.name,
                        .command = std::move(command),
                        .directory = work,
                        .log = study.info.paths.log(claim.key)});
  runs_.emplace(id, UnderWay{claim, time_limit_s});
}

/// Stops a study whose directory somebody has removed: its runs would fail one after the other.
bool Engine::stop_where_lost(const StudyInfo& info, StudyNumber number) {
  const fs::path file = info.paths.resolved_case();
  if (fs::exists(file)) return false;
  kill_runs(number, true);
  store_.abort(number, false, "the study stops: " + file.string() + " is missing");
  return true;
}

/// Accepts a result that a run of an earlier process has left.
bool Engine::take_over(const Claim& claim) {
  const StudyInfo& info = open(claim.study).info;
  try {
    for (const fs::path& file : {info.paths.result(claim.key), info.paths.work(claim.key) / "result.json"})
      if (const auto record = read_result(file, claim.key, info.identity)) {
        if (record->done)
          record_done(claim, *record, Kind::taken_over);
        else
          record_failed(claim, {}, record->reason);
        return true;
      }
  } catch (const ForeignResult& e) {
    kill_runs(claim.study, true);
    store_.abort(claim.study, false, e.what());
    return true;
  }
  return false;
}

bool Engine::record_ended() {
  for (executor::Ended& how : executor_->poll()) runs_.at(how.id).ended = std::move(how);
  bool any = false;
  for (auto run = runs_.begin(); run != runs_.end();) {
    if (!run->second.ended) {
      ++run;
      continue;
    }
    record(run->second);  // if it throws, the run stays and is recorded later
    run = runs_.erase(run);
    any = true;
  }
  return any;
}

void Engine::record(UnderWay& run) {
  const Claim& claim = run.claim;
  if (run.unwanted || !store_.is_current(claim)) {
    // Another attempt of the run may be at work in the directory.
    return report({.kind = Kind::stale, .study = studies_.at(claim.study).info, .claim = claim});
  }
  const StudyInfo& info = open(claim.study).info;
  if (stop_where_lost(info, claim.study)) return;
  make_directories(info.paths);
  RunEnd end{.ended = *run.ended,
             .stopping = stopping_,
             .disk_full = !room_on_disk(),
             .crashes = claim.crashes,
             .attempts = options_.attempts,
             .time_limit_s = run.time_limit_s,
             .last_line = executor::last_line(executor::tail(info.paths.log(claim.key), tail_bytes))};
  std::optional<Record> result;
  if (!end.ended.preempted && !end.ended.end.signal && end.ended.end.exit_code == 0) {
    try {  // in its place: it was moved, but could not be recorded, the last time
      result = read_result(info.paths.work(claim.key) / "result.json", claim.key, info.identity);
      if (!result) result = read_result(info.paths.result(claim.key), claim.key, info.identity);
    } catch (const ForeignResult&) {
      end.wrong_result = true;
    }
  }
  end.has_result = result.has_value();
  if (result && !result->done) end.invalid = result->reason;
  const Outcome outcome = outcome_of(end);
  switch (outcome.action) {
    case Action::done:
      return record_done(claim, *result, Kind::done);
    case Action::failed:
      return record_failed(claim, end.ended, outcome.reason);
    case Action::retry:
      if (outcome.discard_checkpoint) remove_what_goes(info.paths.work(claim.key));
      store_.give_back(claim, outcome.crashed);
      return report({.kind = outcome.crashed ? Kind::crashed : Kind::given_back,
                     .study = info,
                     .claim = claim,
                     .reason = outcome.reason});
    case Action::abort: {
      const std::string log = executor::tail(info.paths.log(claim.key), tail_bytes);
      const std::string why = "the study stops, since " + run_name(claim.key) + " " + outcome.reason +
                              (outcome.bad_case ? ":\n" + log : "");
      run.unwanted = true;
      kill_runs(claim.study, true);
      store_.abort(claim.study, outcome.bad_case, why);
    }
  }
}

/// Keeps the profiles and moves the result before it is recorded: after a kill in between, the next process finds the
/// result and repeats the rest.
void Engine::record_done(const Claim& claim, const Record& record, RunEvent::Kind kind) {
  Study& study = open(claim.study);
  const StudyPaths& paths = study.info.paths;
  const double zone = record.measures.influence_zone;
  if (!claim.key.is_replicate())
    keep_profiles(paths, claim.key, zone, study.estimator.is_farthest(claim.key.index, zone));
  const fs::path left = paths.work(claim.key) / "result.json";
  if (fs::exists(left)) rename_durably(left, paths.result(claim.key));
  if (!store_.accept(claim, record)) return report({.kind = Kind::stale, .study = study.info, .claim = claim});
  std::error_code ignored;
  fs::remove(paths.failure(claim.key), ignored);
  clear_work(paths, claim.key);
  study.estimator.add(claim.key, zone);
  report({.kind = kind, .study = study.info, .claim = claim, .wall_clock = record.wall_clock});
  apply_decision(claim.study);
}

void Engine::record_failed(const Claim& claim, const executor::Ended& how, const std::string& reason) {
  Study& study = open(claim.study);
  Failure failure{.reason = reason, .log_tail = executor::tail(study.info.paths.log(claim.key), tail_bytes)};
  (how.end.signal ? failure.signal : failure.exit_code) = how.end.signal ? how.end.signal : how.end.exit_code;
  write_failure(study.info.paths, claim.key, failure, claim.crashes + 1, study.info.identity.seed);
  if (!store_.fail(claim, failure)) return;
  clear_work(study.info.paths, claim.key);
  study.estimator.add(claim.key, std::nullopt);
  report({.kind = Kind::failed, .study = study.info, .claim = claim, .reason = reason});
  apply_decision(claim.study);
}

/// A study that stops early still owes its replicates; one that has failed owes nothing.
void Engine::apply_decision(StudyNumber number) {
  const Estimator::Decision decision = studies_.at(number).estimator.decision();
  if (decision == Estimator::Decision::go_on) return;
  const bool replicates_too = decision == Estimator::Decision::too_many_failed;
  store_.drop_open_runs(number, replicates_too);
  kill_runs(number, replicates_too);
}

void Engine::kill_runs(StudyNumber number, bool replicates_too) {
  for (auto& [id, run] : runs_) {
    if (run.claim.study != number || run.unwanted || (run.claim.key.is_replicate() && !replicates_too)) continue;
    run.unwanted = true;
    if (!run.ended) executor_->kill(id);
  }
}

void Engine::renew_claims() {
  std::vector<Claim> claims;
  std::vector<executor::RunId> ids;
  for (const auto& [id, run] : runs_) {
    if (run.unwanted) continue;
    claims.push_back(run.claim);
    ids.push_back(id);
  }
  for (const std::size_t i : store_.renew(claims)) {
    runs_.at(ids[i]).unwanted = true;
    executor_->kill(ids[i]);
  }
}

void Engine::stop() {
  stopping_ = true;
  executor_->stop_all();
}

void Engine::close() {
  for (const auto& [id, run] : runs_) {
    try {
      if (!run.unwanted) store_.give_back(run.claim, false);
    } catch (const std::exception&) {  // the next engine on this store requeues it
    }
  }
  runs_.clear();
  executor_.reset();
}

void Engine::clear_work(const StudyPaths& paths, const RunKey& key) const {
  remove_what_goes(paths.work(key));
  std::error_code ignored;
  fs::remove(paths.log(key), ignored);
}

std::vector<std::string> run_arguments(const std::vector<std::string>& program, const StudyInfo& study,
                                       const RunKey& key, int threads) {
  std::vector<std::string> all = program;
  all.insert(all.end(), {study.paths.resolved_case().string(), "--realization", std::to_string(key.drawn_realization()),
                         "--seed", std::to_string(study.identity.seed), "--threads", std::to_string(threads), "--out",
                         study.paths.work(key).string(), "--study-worker"});
  if (key.is_replicate()) all.insert(all.end(), {"--perturbation", perturbation(key)});
  return all;
}

}  // namespace talus

#include "study/directory_store.hpp"

#include "support/files.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

/// The run of a file name: "000012.json" and "000012.failed.json" are of realization 12.
std::optional<RunKey> run_of_file(const std::string& name, const std::string& ending, RunKind kind) {
  if (!name.ends_with(ending)) return std::nullopt;
  std::optional<RunKey> key = run_of_work_name(name.substr(0, name.size() - ending.size()));
  if (!key || key->is_replicate()) return std::nullopt;
  key->kind = kind;
  return key;
}

}  // namespace

StudyIdentity identity(const Plan& plan) {
  return {.seed = plan.seed, .case_hash = plan.of.hash, .earlier = plan.earlier};
}

Records read_records(const StudyPaths& paths, RunKind kind, const StudyIdentity& identity) {
  Records records;
  if (!fs::exists(paths.results(kind))) return records;  // nothing has been run yet
  for (const auto& entry : fs::directory_iterator(paths.results(kind))) {
    const std::string name = entry.path().filename().string();
    if (const auto failed = run_of_file(name, ".failed.json", kind)) {
      if (auto reason = read_failure(entry.path()))
        records.try_emplace(failed->index, failed_record(failed->index, std::move(*reason)));
    } else if (const auto done = run_of_file(name, ".json", kind)) {
      // Where a run has failed too, it was retried: the result counts.
      if (auto record = read_result(entry.path(), *done, identity)) records[done->index] = std::move(*record);
    }
  }
  return records;
}

DirectoryStore::DirectoryStore(StudyPaths paths, const Plan& plan, std::int64_t first, std::int64_t end)
    : info_{.name = {},
            .paths = std::move(paths),
            .identity = identity(plan),
            .spec = plan.study,
            .first = first,
            .end = end},
      runs_(read_records(info_.paths, RunKind::realization, info_.identity)),
      replicates_(read_records(info_.paths, RunKind::replicate, info_.identity)) {}

void DirectoryStore::forget_failures() {
  for (const RunKind kind : {RunKind::realization, RunKind::replicate})
    std::erase_if(records(kind), [&](const auto& of) {
      if (!of.second.done) fs::remove(info_.paths.failure({.kind = kind, .index = of.first}));
      return !of.second.done;
    });
}

std::vector<std::int64_t> DirectoryStore::forget_damaged_profiles() {
  std::optional<std::int64_t> farthest;
  for (const auto& [index, record] : runs_)
    if (record.done && (!farthest || *record.influence_zone() > *runs_.at(*farthest).influence_zone()))
      farthest = index;
  std::vector<std::int64_t> damaged = damaged_profiles(info_.paths, farthest);
  std::erase_if(damaged, [&](std::int64_t index) { return !runs_here({.index = index}) || !runs_.contains(index); });
  for (const std::int64_t index : damaged) {
    fs::remove(info_.paths.result({.index = index}));
    runs_.erase(index);
  }
  return damaged;
}

bool DirectoryStore::runs_here(const RunKey& key) const {
  if (key.is_replicate()) return info_.first == 0 && !dropped_replicates_;
  return key.index >= info_.first && key.index < info_.end && !dropped_realizations_;
}

std::optional<Claim> DirectoryStore::claim() {
  if (!returned_.empty()) {
    Claim claim = returned_.front();
    returned_.pop_front();
    ++claim.attempt;
    claimed_[claim.key] = claim.attempt;
    return claim;
  }
  const std::int64_t replicates = info_.spec.noise_floor_replicates;
  for (const std::int64_t last = replicates + info_.end; rank_ < last;) {
    const RunKey key = run_of_rank(rank_++, replicates);
    if (!runs_here(key) || records(key.kind).contains(key.index)) continue;
    claimed_[key] = 1;
    return Claim{.key = key};
  }
  return std::nullopt;
}

void DirectoryStore::visit_records(StudyNumber, const Visitor& visit) {
  for (const RunKind kind : {RunKind::realization, RunKind::replicate})
    for (const auto& [index, record] : records(kind)) visit({.kind = kind, .index = index}, record.influence_zone());
}

bool DirectoryStore::is_current(const Claim& claim) {
  const auto at = claimed_.find(claim.key);
  return at != claimed_.end() && at->second == claim.attempt;
}

bool DirectoryStore::end_claim(const Claim& claim) {
  const bool current = is_current(claim);
  if (current) claimed_.erase(claim.key);
  return current;
}

bool DirectoryStore::accept(const Claim& claim, const Record& record) {
  if (!end_claim(claim)) return false;
  records(claim.key.kind)[claim.key.index] = record;
  return true;
}

bool DirectoryStore::fail(const Claim& claim, const Failure& failure) {
  if (!end_claim(claim)) return false;
  records(claim.key.kind)[claim.key.index] = failed_record(claim.key.index, failure.reason);
  return true;
}

bool DirectoryStore::give_back(const Claim& claim, bool crashed) {
  if (!end_claim(claim)) return false;
  Claim returned = claim;
  returned.crashes += crashed ? 1 : 0;
  returned_.push_front(returned);
  return true;
}

void DirectoryStore::drop_open_runs(StudyNumber, bool replicates_too) {
  dropped_realizations_ = true;
  dropped_replicates_ = dropped_replicates_ || replicates_too;
  std::erase_if(returned_, [&](const Claim& claim) { return !runs_here(claim.key); });
  std::erase_if(claimed_, [&](const auto& claimed) { return !runs_here(claimed.first); });
}

void DirectoryStore::abort(StudyNumber, bool bad_case, const std::string& why) {
  if (bad_case) throw ConfigError("", why);
  throw IoError(why);
}

}  // namespace talus

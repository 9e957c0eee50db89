#include "jobs/repair.hpp"

#include <algorithm>
#include <set>

#include "base/json.hpp"
#include "jobs/job_record.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_stored_case_bytes = std::size_t{1} << 28;

/// What `read` gives; nothing, and a line in the log, where the file is damaged.
template <class Read>
auto unless_damaged(const Job& job, const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const IoError& e) {
    log_error("damaged", {{"job", job.id}, {"why", e.what()}});
    return std::nullopt;
  }
}

/// A resolved case, for a number of realizations: extensions change nothing else in it.
Json with_realizations(Json document, std::int64_t realizations) {
  document["study"]["realizations"] = realizations;
  return document;
}

/// Calls `use(key, record)` for each run that is done in the queue.
template <class Use>
void visit_done(const Job& job, Store& store, const Use& use) {
  for (const RunKind kind : {RunKind::realization, RunKind::replicate})
    store.records(job.number, kind)([&](const Record& record) {
      if (record.done) use(RunKey{.kind = kind, .index = record.index}, record);
    });
}

bool is_result_of(const fs::path& file, const RunKey& key, const StudyIdentity& of, const Record& recorded) {
  try {
    const std::optional<Record> found = read_result(file, key, of);
    return found && found->done && found->digest == recorded.digest;
  } catch (const ForeignResult& e) {
    log_error("foreign_result", {{"file", file.string()}, {"why", e.what()}});
    rename_durably(file, fs::path(file).concat(".foreign"));
    return false;
  }
}

}  // namespace

fs::path checked_case(const DataDirectory& data, const Job& job) {
  const fs::path directory = data.job(job.id), path = StudyPaths{directory}.resolved_case();
  if (!fs::exists(directory)) throw IoError("the directory of the job is missing: " + directory.string());
  const auto record = unless_damaged(job, [&] { return find_job_record(directory); });
  const auto found = unless_damaged(job, [&] { return std::optional(read_json(path, max_stored_case_bytes)); });
  if (!record && !found) throw IoError("the case of the job is lost: " + path.string());
  if (!record) return path;
  const Json document = with_realizations(record->document, job.planned);
  if (found && with_realizations(*found, job.planned) == document) return path;
  write_file_atomically(path, document.dump(2) + "\n");
  log_error("made_again", {{"job", job.id}, {"file", path.string()}});
  return path;
}

void repair_directory(const DataDirectory& data, const Job& job, const fs::path& made) {
  const fs::path directory = data.job(job.id);
  const std::optional<Plan> right = find_plan(made);
  if (!right || right->of.hash != job.case_hash)
    throw IoError("the case of the job is damaged: " + StudyPaths{directory}.resolved_case().string());
  const auto plan = unless_damaged(job, [&] { return find_plan(directory); });
  const auto marker = unless_damaged(job, [&] { return find_output_marker(directory); });
  const auto make_again = [&](const fs::path& file) {
    write_file_atomically(directory / file, read_file(made / file, max_stored_case_bytes));
    log_error("made_again", {{"job", job.id}, {"file", (directory / file).string()}});
  };
  if (!plan || plan->of.hash != job.case_hash || plan->seed != right->seed)
    make_again(StudyPaths{made}.plan().filename());
  if (!marker || marker->of.hash != job.case_hash) make_again(output_marker_path(made).filename());
  if (!unless_damaged(job, [&] { return find_job_record(directory); })) write_job_record(directory, job, job.created);
}

std::vector<RunKey> missing_results(const DataDirectory& data, const Job& job, Store& store) {
  const StudyPaths paths{data.job(job.id)};
  std::set<fs::path> found;
  for (const RunKind kind : {RunKind::realization, RunKind::replicate})
    if (fs::exists(paths.results(kind)))
      for (const auto& entry : fs::directory_iterator(paths.results(kind))) found.insert(entry.path());
  std::vector<RunKey> missing;
  visit_done(job, store, [&](const RunKey& key, const Record&) {
    if (!found.contains(paths.result(key))) missing.push_back(key);
  });
  return missing;
}

std::vector<RunKey> lost_results(const DataDirectory& data, const Job& job, Store& store) {
  const StudyPaths paths{data.job(job.id)};
  const StudyIdentity identity{.seed = static_cast<std::uint64_t>(job.seed), .case_hash = job.case_hash};
  std::vector<RunKey> lost;
  std::optional<std::int64_t> farthest;
  double zone = 0.0;  // of the farthest [m]
  visit_done(job, store, [&](const RunKey& key, const Record& record) {
    if (!is_result_of(paths.result(key), key, identity, record)) lost.push_back(key);
    if (!key.is_replicate() && (!farthest || record.measures.influence_zone > zone)) {
      farthest = key.index;
      zone = record.measures.influence_zone;
    }
  });
  for (const std::int64_t index : damaged_profiles(paths, farthest)) {
    const RunKey key{.index = index};
    if (std::ranges::find(lost, key) != lost.end()) continue;
    log_error("damaged", {{"job", job.id}, {"why", "the kept profile of " + run_name(key)}});
    fs::remove(paths.result(key));  // or it would be taken instead of running it again
    lost.push_back(key);
  }
  return lost;
}

}  // namespace talus::service

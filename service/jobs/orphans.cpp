#include "jobs/orphans.hpp"

#include <algorithm>

#include "base/digest.hpp"
#include "base/json.hpp"
#include "jobs/job_record.hpp"
#include "process/short_command.hpp"
#include "study/directory_store.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

bool is_unfinished_submission(const std::string& name) {
  const std::string_view prefix = DataDirectory::unfinished_prefix;
  return name.starts_with(prefix) && is_random_hex(name.substr(prefix.size()), DataDirectory::id_bytes);
}

/// A directory of Jobs or of a short command.
bool is_scratch(std::string_view name) {
  if (name.starts_with(command_prefix)) name.remove_prefix(command_prefix.size());
  return is_random_hex(name, DataDirectory::scratch_bytes);
}

/// A name in DATA/orphans that is not taken.
fs::path free_place(const DataDirectory& data, const std::string& name) {
  fs::path place = data.orphans() / name;
  for (int copy = 2; fs::exists(fs::symlink_status(place)); ++copy)
    place = data.orphans() / (name + "-" + std::to_string(copy));
  return place;
}

void put_aside(const DataDirectory& data, const fs::path& found, const char* why) {
  fs::create_directories(data.orphans());
  const fs::path place = free_place(data, found.filename().string());
  fs::rename(found, place);
  log_error("orphan", {{"directory", found.string()}, {"moved_to", place.string()}, {"why", why}});
}

void remove_if_possible(const fs::path& directory) {
  std::error_code error;
  fs::remove_all(directory, error);
  if (error) log_info("not_removed_yet", {{"directory", directory.string()}, {"why", error.message()}});
}

std::vector<fs::path> entries(const fs::path& directory) {
  std::vector<fs::path> all;
  if (!fs::exists(directory)) return all;
  for (const auto& entry : fs::directory_iterator(directory)) all.push_back(entry.path());
  return all;
}

/// A directory in DATA/orphans with the record of its job.
struct Found {
  fs::path directory;
  JobRecord record;
};

/// Gives a job of the queue its directory back. @return why not; empty: it was done
std::string give_back(const DataDirectory& data, const Job& known, const fs::path& directory) {
  if (known.state == JobState::dismissed) return "the job was dismissed";
  if (fs::exists(data.job(known.id))) return "the job has a directory already";
  rename_durably(directory, data.job(known.id));
  return "";
}

/// Records a job that the queue has lost.
std::string record_again(const DataDirectory& data, Store& store, const Found& found) {
  NewJob job = found.record.job;
  const std::optional<Plan> plan = find_plan(found.directory);
  if (!plan) throw IoError("there is no plan.json");
  if (plan->of.hash != job.case_hash) throw IoError("its plan.json is of another case than its job.json");
  job.planned = std::max(job.planned, plan->study.realizations);
  const fs::path place = data.job(job.id);
  if (fs::exists(place)) throw IoError(place.string() + " exists");
  const StudyIdentity identity{.seed = static_cast<std::uint64_t>(job.seed), .case_hash = job.case_hash};
  const Records runs = read_records({found.directory}, RunKind::realization, identity);
  const Records replicates = read_records({found.directory}, RunKind::replicate, identity);
  rename_durably(found.directory, place);
  const Job made = store.recreate(job, found.record.created, runs, replicates);
  return std::to_string(made.done) + " of " + std::to_string(made.planned) + " realizations done, " +
         std::to_string(made.failed) + " failed";
}

Adoption adopt(const DataDirectory& data, Store& store, const Found& found) {
  Adoption adoption{.name = found.directory.filename().string(), .message = {}};
  try {
    if (const std::optional<Job> known = store.job(found.record.job.id)) {
      adoption.message = give_back(data, *known, found.directory);
      adoption.adopted = adoption.message.empty();
      if (adoption.adopted) adoption.message = "directory returned to its job";
    } else {
      adoption.message = record_again(data, store, found);
      adoption.adopted = true;
    }
  } catch (const IoError& e) {
    adoption.message = e.what();
  }
  return adoption;
}

}  // namespace

void put_orphans_aside(const DataDirectory& data, const std::set<std::string>& known) {
  for (const fs::path& entry : entries(data.jobs())) {
    const std::string name = entry.filename().string();
    if (known.contains(name)) continue;
    if (is_unfinished_submission(name))
      remove_if_possible(entry);
    else
      put_aside(data, entry, "the queue knows no job of this name; was the queue lost or restored?");
  }
  for (const fs::path& entry : entries(data.scratch())) {
    if (is_scratch(entry.filename().string()))
      remove_if_possible(entry);
    else
      put_aside(data, entry, "talusd did not make it");
  }
}

std::size_t count_orphans(const DataDirectory& data) {
  std::error_code error;
  fs::directory_iterator at(data.orphans(), error);
  return error ? 0 : static_cast<std::size_t>(std::distance(fs::begin(at), fs::end(at)));
}

std::vector<Adoption> adopt_orphans(const DataDirectory& data, Store& store) {
  std::vector<Adoption> all;
  std::vector<Found> found;
  for (const fs::path& entry : entries(data.orphans())) {
    try {
      if (auto record = find_job_record(entry))
        found.push_back({entry, std::move(*record)});
      else
        all.push_back({.name = entry.filename().string(), .message = "there is no job.json"});
    } catch (const IoError& e) {
      all.push_back({.name = entry.filename().string(), .message = e.what()});
    }
  }
  std::ranges::sort(found, {}, [](const Found& of) { return std::pair(of.record.created, of.record.job.id); });
  for (const Found& of : found) all.push_back(adopt(data, store, of));
  return all;
}

void check_job_records(const DataDirectory& data, Store& store) {
  store.visit_studies([&](const Job& job) {
    const fs::path directory = data.job(job.id);
    if (!fs::exists(StudyPaths{directory}.resolved_case())) {
      log_error("job_directory_missing", {{"job", job.id}, {"directory", directory.string()}});
      return;
    }
    try {
      if (const std::optional<JobRecord> record = find_job_record(directory)) {
        if (store.restore(job, record->job)) log_error("damaged_row", {{"what", "job " + job.id}});
      } else {
        write_job_record(directory, job, job.created);
      }
    } catch (const IoError& e) {
      log_error("job_record", {{"job", job.id}, {"why", e.what()}});
    }
  });
}

}  // namespace talus::service

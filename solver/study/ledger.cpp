#include "study/ledger.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "study/run_file.hpp"
#include "support/files.hpp"
#include "support/json.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t max_failure_bytes = std::size_t{1} << 20;

/// The job of a file name: "000012.json" and "000012.failed.json" are of realization 12.
std::optional<std::int64_t> index_of(const std::string& name, const std::string& ending) {
  if (!name.ends_with(ending)) return std::nullopt;
  const char* end = name.data() + name.size() - ending.size();
  std::int64_t index = 0;
  const auto [stop, error] = std::from_chars(name.data(), end, index);
  return error == std::errc() && stop == end && index >= 0 ? std::optional(index) : std::nullopt;
}

bool before(const Record& record, std::int64_t index) { return record.index < index; }

void insert(std::vector<Record>& records, Record record) {
  const auto at = std::lower_bound(records.begin(), records.end(), record.index, before);
  if (at != records.end() && at->index == record.index)
    *at = std::move(record);
  else
    records.insert(at, std::move(record));
}

/// The reason in a file that commit_failure wrote; nothing where it cannot be read.
std::optional<std::string> failure_reason(const fs::path& file) {
  try {
    return read_json(file, max_failure_bytes).at("reason").get<std::string>();
  } catch (const nlohmann::json::exception&) {
  } catch (const IoError&) {
  }
  return std::nullopt;
}

/// Puts a second name on a file, or a copy where the file system has no links; by rename.
void link_or_copy(const fs::path& from, const fs::path& to) {
  const fs::path temporary = to.parent_path() / (to.filename().string() + ".tmp-profile");
  fs::remove(temporary);
  std::error_code error;
  fs::create_hard_link(from, temporary, error);
  if (error) fs::copy_file(from, temporary);
  fs::rename(temporary, to);
}

/// Runs `action`; what the file system complains about becomes an IoError.
template <class Action>
void on_disk(const char* verb, const fs::path& path, Action action) {
  try {
    action();
  } catch (const fs::filesystem_error& e) {
    throw_io_error(verb, e.path1().empty() ? path : e.path1(), e.code().value());
  }
}

}  // namespace

Ledger::Ledger(StudyPaths paths, const Plan& plan)
    : paths_(std::move(paths)), seed_(plan.seed), case_hash_(plan.case_hash) {
  on_disk("read", paths_.root, [&] {
    scan(false);
    scan(true);
  });
}

void Ledger::make_directories() const {
  on_disk("write", paths_.root, [&] {
    for (const fs::path& directory : {paths_.runs(), paths_.floor(), paths_.work(), paths_.profiles()})
      fs::create_directories(directory);
  });
}

void Ledger::scan(bool floor) {
  const fs::path directory = floor ? paths_.floor() : paths_.runs();
  if (!fs::exists(directory)) return;  // nothing has been run yet
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (const auto failed = index_of(name, ".failed.json")) {
      const Job job{floor, *failed};
      const auto reason = failure_reason(entry.path());
      if (reason && !has(job)) insert(records(job), {.index = job.index, .reason = *reason});
    } else if (const auto done = index_of(name, ".json")) {
      const Job job{floor, *done};
      if (auto record = read(job, entry.path())) insert(records(job), std::move(*record));
    }
  }
}

std::optional<Record> Ledger::read(Job job, const fs::path& file) const {
  std::optional<RunFile> run;
  try {
    run = read_run_file(file, job.index);
  } catch (const IoError&) {
    return std::nullopt;  // missing, or damaged by a crash of the machine: the job is simply run again
  }
  const std::int64_t realization = job.floor ? 0 : job.index;
  if (run->seed != seed_ || run->case_hash != case_hash_ || run->realization != realization)
    throw IoError(file.string() + " is of another study (seed, case hash or realization differ); remove it");
  if (run->interrupted) return std::nullopt;
  return std::move(run->record);
}

bool Ledger::has(Job job) const {
  const std::vector<Record>& all = job.floor ? floor_ : runs_;
  const auto at = std::lower_bound(all.begin(), all.end(), job.index, before);
  return at != all.end() && at->index == job.index;
}

bool Ledger::finished_in_work(Job job) const { return read(job, paths_.work(job) / "result.json").has_value(); }

void Ledger::commit(Job job) {
  const fs::path result = paths_.work(job) / "result.json";
  std::optional<Record> record = read(job, result);
  if (!record) throw IoError(result.string() + " is missing or cannot be read");
  on_disk("write", paths_.root, [&] {
    // The profiles first: a study killed in between finds the result still in the working directory and does both
    // again.
    if (!job.floor) keep_profiles(*record);
    fs::rename(result, paths_.result(job));
    fs::remove(paths_.failure(job));
    remove_what_goes(paths_.work(job));
    fs::remove(paths_.log(job));
  });
  insert(records(job), std::move(*record));
}

void Ledger::keep_profiles(const Record& record) {
  const fs::path snapshots = paths_.work(Job{.index = record.index}) / "snapshots.vtkhdf";
  if (!fs::exists(snapshots)) return;
  if (record.index == 0) link_or_copy(snapshots, paths_.profiles() / "first.vtkhdf");
  const double x = record.measures.influence_zone;
  const bool beaten = std::any_of(runs_.begin(), runs_.end(), [&](const Record& r) {
    const double other = r.measures.influence_zone;
    return r.done && r.index != record.index && (other > x || (other == x && r.index < record.index));
  });
  if (beaten) return;
  link_or_copy(snapshots, paths_.profiles() / "worst.vtkhdf");
  write_file_atomically(paths_.profiles() / "worst.json",
                        ordered_json{{"realization", record.index}, {"influence_zone_m", x}}.dump(2) + "\n");
}

void Ledger::commit_failure(Job job, const Failure& failure) {
  const ordered_json json = {{"job", job_name(job)},
                             {"reason", failure.reason},
                             {"exit_code", failure.signal ? ordered_json() : ordered_json(failure.exit_code)},
                             {"signal", failure.signal ? ordered_json(failure.signal) : ordered_json()},
                             {"attempts", failure.attempts},
                             {"log_tail", failure.log_tail},
                             {"rerun", failure.rerun}};
  write_file_atomically(paths_.failure(job), json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  on_disk("write", paths_.root, [&] {
    remove_what_goes(paths_.work(job));
    fs::remove(paths_.log(job));
  });
  insert(records(job), {.index = job.index, .reason = failure.reason});
}

void Ledger::forget_failures() {
  for (const bool floor : {false, true}) {
    auto& all = floor ? floor_ : runs_;
    on_disk("write", paths_.root, [&] {
      for (const Record& r : all)
        if (!r.done) fs::remove(paths_.failure({floor, r.index}));
    });
    std::erase_if(all, [](const Record& r) { return !r.done; });
  }
}

}  // namespace talus

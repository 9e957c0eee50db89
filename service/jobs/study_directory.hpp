#pragma once
// Where things lie beneath DATA, and the files of a study as `talus` knows them.

#include <filesystem>
#include <optional>
#include <string>

#include "base/json.hpp"
#include "queue/records.hpp"

namespace talus::service {

struct DataDirectory {
  std::filesystem::path root;

  std::filesystem::path database() const { return root / "queue.sqlite"; }
  std::filesystem::path lock() const { return root / "talusd.lock"; }
  std::filesystem::path workers_lock() const { return root / "workers.lock"; }
  std::filesystem::path jobs() const { return root / "jobs"; }
  std::filesystem::path scratch() const { return root / "scratch"; }
  std::filesystem::path slurm() const { return root / "slurm"; }
  std::filesystem::path orphans() const { return root / "orphans"; }  ///< directories that the queue did not know
  std::filesystem::path job(const std::string& id) const { return jobs() / id; }
  /// The directory of a job until its submission is complete; removed when talusd starts.
  std::filesystem::path unfinished(const std::string& id) const { return jobs() / (unfinished_prefix + id); }
  static constexpr const char* unfinished_prefix = "new-";
};

/// The directory of one job: that of a `talus study`, so that every verb of talus reads it.
struct StudyDirectory {
  std::filesystem::path root;

  std::filesystem::path resolved_case() const { return root / "case.resolved.json"; }
  std::filesystem::path plan() const { return root / "plan.json"; }
  std::filesystem::path summary() const { return root / "study.json"; }
  std::filesystem::path result(const RunKey& run) const;   ///< runs/000012.json, floor/3.json
  std::filesystem::path failure(const RunKey& run) const;  ///< runs/000012.failed.json
  std::filesystem::path work(const RunKey& run) const;     ///< work/000012: where its process writes
  std::filesystem::path log(const RunKey& run) const;
  std::filesystem::path profiles() const { return root / "profiles"; }
};

/// The result in a file, if it is there, whole, of a run that came to its end, and of this very run.
std::optional<RunResult> read_result(const std::filesystem::path& file, const RunKey& run, std::int64_t seed,
                                     const std::string& case_hash);

/// The record that `talus stats --from-runs` reads of a run that failed.
void write_failure(const StudyDirectory& study, const RunKey& run, const RunFailure& failure, std::int64_t attempts,
                   const std::string& rerun);

/// "talus run case.resolved.json --realization 7 --seed 1 --out DIR"
std::string replay_command(const RunKey& run, std::int64_t seed);

/// 1e-6 k in the shortest form that reads back.
std::string perturbation(std::int64_t k);

}  // namespace talus::service

#pragma once
// The layout of DATA, the data directory of talusd.

#include <filesystem>
#include <string>

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
  /// The directory of one job: that of a `talus study`, so that every subcommand of talus reads it.
  std::filesystem::path job(const std::string& id) const { return jobs() / id; }
  /// The directory of a job until its submission is complete; removed when talusd starts.
  std::filesystem::path unfinished(const std::string& id) const { return jobs() / (unfinished_prefix + id); }
  static constexpr const char* unfinished_prefix = "new-";
};

}  // namespace talus::service

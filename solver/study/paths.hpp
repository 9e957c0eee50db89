#pragma once
// Where things lie in the directory of a study.

#include <cstdint>
#include <filesystem>
#include <string>

namespace talus {

/// One run of a study: a realization, or a replicate of realization 0 that measures the noise floor (k = 1, 2, ...).
struct Job {
  bool floor = false;
  std::int64_t index = 0;  ///< realization, or k
  bool operator==(const Job&) const = default;
};

/// "realization 12", "noise-floor replicate 3"
std::string job_name(Job job);

struct StudyPaths {
  std::filesystem::path root;

  std::filesystem::path resolved_case() const { return root / "case.resolved.json"; }
  std::filesystem::path realizations() const { return root / "realizations.csv"; }
  std::filesystem::path noise_floor() const { return root / "noise_floor.csv"; }
  std::filesystem::path summary() const { return root / "study.json"; }
  std::filesystem::path profiles() const { return root / "profiles"; }
  std::filesystem::path figures() const { return root / "figures"; }
  std::filesystem::path work() const { return root / "work"; }
  std::filesystem::path runs() const { return root / "runs"; }
  std::filesystem::path floor() const { return root / "floor"; }

  std::filesystem::path result(Job job) const;   ///< runs/000012.json, floor/3.json
  std::filesystem::path failure(Job job) const;  ///< runs/000012.failed.json
  std::filesystem::path work(Job job) const;     ///< work/000012, work/floor-3: where its process writes
  std::filesystem::path log(Job job) const;      ///< work/000012.log
};

}  // namespace talus

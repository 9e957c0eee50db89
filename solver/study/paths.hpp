#pragma once
// The layout of a study directory.

#include <filesystem>

#include "study/run_key.hpp"

namespace talus {

struct StudyPaths {
  std::filesystem::path root;

  std::filesystem::path resolved_case() const { return root / "case.resolved.json"; }
  std::filesystem::path plan() const { return root / "plan.json"; }
  std::filesystem::path realizations() const { return root / "realizations.csv"; }
  std::filesystem::path noise_floor() const { return root / "noise_floor.csv"; }
  std::filesystem::path summary() const { return root / "study.json"; }
  std::filesystem::path profiles() const { return root / "profiles"; }
  std::filesystem::path figures() const { return root / "figures"; }
  std::filesystem::path work() const { return root / "work"; }
  std::filesystem::path runs() const { return root / "runs"; }
  std::filesystem::path floor() const { return root / "floor"; }

  std::filesystem::path results(RunKind kind) const { return kind == RunKind::replicate ? floor() : runs(); }
  std::filesystem::path result(const RunKey& key) const {  ///< runs/000012.json, floor/3.json
    return results(key.kind) / (file_stem(key) + ".json");
  }
  std::filesystem::path failure(const RunKey& key) const {  ///< runs/000012.failed.json
    return results(key.kind) / (file_stem(key) + ".failed.json");
  }
  /// work/000012, work/floor-3: where the process of a run writes.
  std::filesystem::path work(const RunKey& key) const { return work() / work_name(key); }
  std::filesystem::path log(const RunKey& key) const { return work(key).concat(".log"); }  ///< work/000012.log
};

}  // namespace talus

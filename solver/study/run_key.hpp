#pragma once
// The identity of a run within its study, in files, tables, SQL and replay commands; and the layout of a study
// directory.

#include <compare>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace talus {

enum class RunKind {
  realization,  ///< index 0, 1, ...: a draw of its own
  replicate,    ///< index 1, 2, ...: realization 0 with tan(phi) scaled by 1 + 1e-6 index; measures the numerical noise
};

struct RunKey {
  int level = 0;  ///< of resolution; only 0 today
  RunKind kind = RunKind::realization;
  std::int64_t index = 0;
  auto operator<=>(const RunKey&) const = default;
  bool is_replicate() const { return kind == RunKind::replicate; }
  /// The realization whose random numbers the run uses.
  std::int64_t drawn_realization() const { return is_replicate() ? 0 : index; }
};

inline RunKey realization(std::int64_t index) { return {.index = index}; }
inline RunKey replicate(std::int64_t index) { return {.kind = RunKind::replicate, .index = index}; }

/// "realization 12", "noise-floor replicate 3"
std::string run_name(const RunKey& key);

/// The file name of a run without its extension: "000012", "3".
std::string file_stem(const RunKey& key);

/// The name of the working directory of a run ("000012", "floor-3"), and back.
std::string work_name(const RunKey& key);
std::optional<RunKey> run_of_work_name(const std::string& name);

/// The scale of tan(phi) minus 1, for `talus run --perturbation`; empty for a realization.
std::string perturbation(const RunKey& key);

/// "talus run CASE --realization 7 --seed 1 --out DIR"
std::string replay_command(const RunKey& key, std::uint64_t seed, const std::string& case_file);

/// The layout of a study directory.
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

#pragma once
// result.json: the outcome of a run and where it came from; described by schemas/result.schema.json.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "simulation/run_result.hpp"

namespace talus {

/// Where a result came from: enough to compute it again.
struct Provenance {
  std::string version;                      ///< of Talus
  std::uint64_t seed = 0;                   ///< of the random field
  std::optional<std::int64_t> realization;  ///< unset: the deterministic case
  std::optional<double> perturbation;       ///< relative change of tan(phi) of a noise-floor replicate [-]
  std::string case_hash;                    ///< LoadedCase::hash
  std::string case_title;
  std::string compiler;
  std::string started_utc;  ///< "2025-01-31T12:00:00Z"
};

/// The document; angles in degrees, `realization` and `perturbation` null where unset.
/// @throws std::domain_error naming the key of a number that is not finite: JSON has no word for it
nlohmann::ordered_json result_json(RunResult result, Provenance provenance);

/// Reads a result.json. Keys that it does not know are passed over: a later version may have written them.
/// @throws IoError naming the file and, with its JSON pointer, the first key that is missing or wrong
std::pair<RunResult, Provenance> read_result(const std::filesystem::path& path);

}  // namespace talus

#pragma once
// What became of one run.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "study/paths.hpp"
#include "support/error.hpp"
#include "support/measures.hpp"

namespace talus {

/// A finished or failed run. Of a failed one only `index` and `reason` mean anything.
struct Record {
  std::int64_t index = 0;          ///< realization, or replicate
  bool done = false;               ///< false: failed
  Measures measures = {};          ///< [m]
  double mean_phi_deg = 0.0;       ///< mean friction angle over the soil particles [deg]
  double captured_variance = 0.0;  ///< [-]
  std::int64_t steps = 0;
  double wall_clock = 0.0;  ///< [s]
  std::string digest = {};  ///< of the final state
  std::string reason = {};  ///< why it failed, one line; empty if done
};

/// Why a run failed.
struct Failure {
  std::string reason;  ///< one line
  std::optional<int> exit_code = {}, signal = {};
  std::string log_tail = {};
};

/// What tells the runs of one study from those of another.
struct StudyIdentity {
  std::uint64_t seed = 0;
  std::string case_hash;
};

/// A result.json of another run or another study.
struct ForeignResult : IoError {
  using IoError::IoError;
};

/// The record in a result.json of `key` that came to its end; nothing where the file is missing, damaged (the run is
/// then carried out again) or of an interrupted run.
/// @throws ForeignResult
std::optional<Record> read_result(const std::filesystem::path& file, const RunKey& key, const StudyIdentity& of);

/// Writes the failure record of a run (000012.failed.json), whole or not at all.
/// @throws IoError
void write_failure(const StudyPaths& paths, const RunKey& key, const Failure& failure, std::int64_t attempts,
                   std::uint64_t seed);

/// The reason in a failure record; nothing where it cannot be read.
std::optional<std::string> read_failure(const std::filesystem::path& file);

/// Keeps the snapshots of realization 0 as profiles/first.vtkhdf and those of the farthest so far as
/// profiles/worst.vtkhdf, with its number in worst.json. Does nothing for a run that wrote no snapshots.
/// @param farthest  no recorded realization went farther
/// @throws IoError
void keep_profiles(const StudyPaths& paths, const RunKey& key, double influence_zone, bool farthest);

}  // namespace talus

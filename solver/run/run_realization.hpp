#pragma once
// One realization of a case, from its identity to a finished directory.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "case/load.hpp"
#include "run/realization.hpp"
#include "simulation/simulation.hpp"

namespace talus {

/// Which realization to run, and where.
struct RunRequest {
  std::filesystem::path directory;          ///< created, or ours
  bool resume = false;                      ///< accept a finished run, and continue one of an earlier end
  bool keep_final_state = false;            ///< leave a checkpoint of a run that ends while it moves
  std::uint64_t seed = 0;                   ///< of the random field
  std::optional<std::int64_t> realization;  ///< unset: the median run
  std::optional<double> perturbation;       ///< relative change of tan(phi) [-], for replicates of the noise floor
  std::optional<int> threads;               ///< unset: as many as pay
  std::string version;                      ///< of Talus, for the provenance
};

/// What the caller does while the run goes on; the first two are called after every step.
struct RunHooks {
  std::function<bool()> stop_requested;  ///< true: write a checkpoint and return
  std::function<void(const Simulation& simulation, double elapsed_s)> show_progress;
  std::function<void(double time_s)> continued = [](double) {};  ///< called once, if it goes on from a checkpoint
  std::function<void(const std::vector<Fault>&)> warn = [](const auto&) {};  ///< called once, before the first step
};

/// How a call of run_realization ended.
struct RunOutcome {
  bool finished = false;  ///< otherwise stopped on request, with a checkpoint
  double time = 0.0;      ///< simulated time reached [s]
  RunResult result;       ///< of a finished run
  std::string document;   ///< result.json of a finished run
};

/// The seed of a run: `given`, else that of the run already begun in `directory`, else the case's, else one from the
/// machine's entropy. At most 53 bits, so that every reader of JSON keeps it exact.
std::uint64_t choose_seed(std::optional<std::uint64_t> given, const LoadedCase& loaded,
                          const std::filesystem::path& directory);

/// Runs one realization and writes case.resolved.json (with the seed), snapshots, history, a checkpoint every minute
/// and, at the end, result.json. An unfinished run in the directory goes on from its checkpoint. With `resume`, a
/// directory that holds the finished run is only read, and one that moved at its earlier end goes on from there.
/// Sets the number of OpenMP threads of the process. Not thread-safe: one at a time in a process.
/// @throws ConfigError when the particles or the random field cannot be made
/// @throws DivergedError; the history up to then is kept
/// @throws IoError when the directory is not ours, holds another run, or cannot be read or written
RunOutcome run_realization(LoadedCase loaded, const RunRequest& request, const RunHooks& hooks);

}  // namespace talus

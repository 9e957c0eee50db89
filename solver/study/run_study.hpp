#pragma once
// `talus study`: one study in one directory. It can be killed at any time and goes on by the same command.

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "executor/executor.hpp"
#include "statistics/controlled_mean.hpp"
#include "study/outcome.hpp"
#include "study/plan.hpp"
#include "study/run_key.hpp"

namespace talus {

/// Where a study stands.
struct Progress {
  std::int64_t planned = 0;  ///< realizations to be run here
  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::int64_t floor_planned = 0;  ///< noise-floor replicates
  std::int64_t floor_made = 0;     ///< done or failed
  std::int64_t made_now = 0;       ///< runs ended since this process began
  std::int64_t run_again = 0;      ///< runs of this process that crashed or hung and were run again
  int running = 0;
  double elapsed = 0.0;                             ///< since this process began [s]
  std::optional<double> mean = {};                  ///< influence zone [m]
  std::optional<double> mean_half_width = {};       ///< of its 95 % interval [m]
  std::optional<ControlledMean> leading_mean = {};  ///< of the leading measure by regression, a while ago [m]
  std::string pending_reason = {};                  ///< why no run is under way, where that is known
};

/// How to run a study; none of it changes a result.
struct RunStudyOptions {
  std::vector<std::string> program;  ///< called as `program... CASE --realization I ...`: the arguments of `talus run`
  int workers = 1;                   ///< processes at a time, >= 1; without `make_executor`
  std::function<std::unique_ptr<executor::Executor>(const StudyPaths&)> make_executor;  ///< unset: processes here
  int threads = 1;                                                                      ///< of each, >= 1
  std::int64_t first = 0;            ///< realizations first <= i < last are run here, the others elsewhere
  std::optional<std::int64_t> last;  ///< unset: the planned number
  int attempts = default_attempts;   ///< crashes of a run before it has failed, >= 1
  std::uint64_t time_limit_s = 0;    ///< of a run [s], which fails beyond it; 0: none
  std::uint64_t stall_limit_s = 0;   ///< without any use of the CPU [s], after which a run is run again; 0: none
  bool retry_failed = false;         ///< run again what has failed before
  bool resume = false;               ///< accept a study of an earlier end: what still moved there is run again
  /// How often a person has asked to stop: once, workers checkpoint; twice, they are killed.
  std::function<int()> interrupts;
  std::function<void(const Progress&)> report;   ///< called often
  std::function<void(const std::string&)> note;  ///< called when something happens that a person should know
  std::chrono::milliseconds poll{25};
  std::chrono::milliseconds publish_every{5000};  ///< between two rewrites of the tables while running
  std::chrono::seconds grace{60};                 ///< for workers to checkpoint, or for those of a killed study to end
};

/// Makes `directory` the directory of the study without running anything: the plan and the case, for the process that
/// runs the realizations; a plan that is there already may be made longer.
/// @throws ConfigError, IoError as run_study
void prepare_study(const Plan& plan, const nlohmann::ordered_json& resolved, const std::filesystem::path& directory);

enum class StudyEnd { finished, stopped_early, interrupted, too_many_failed };

/// Runs what `plan` asks for and `directory` does not hold yet. What the end of a process means: outcome_of().
/// @param resolved  LoadedCase::resolved of `plan`; what the workers read
/// @throws ConfigError when the directory holds another study, or a worker refuses the case
/// @throws IoError when the directory cannot be claimed or written, or a worker cannot write; the same command goes on
StudyEnd run_study(const Plan& plan, const nlohmann::ordered_json& resolved, const std::filesystem::path& directory,
                   const RunStudyOptions& options);

}  // namespace talus

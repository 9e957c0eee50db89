#pragma once
// How runs are submitted to Slurm. Comes from a file of the operator, never from a request.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace talus::executor {

struct SlurmConfig {
  std::string partition, account;           ///< empty: Slurm's default
  int time_limit_min = 60;                  ///< of an array task [min], >= 1; longer runs continue in another task
  int memory_MiB = 0;                       ///< of an array task; 0: the partition's default
  int cpus_per_task = 0;                    ///< 0: the threads of a run
  std::vector<std::string> sbatch_options;  ///< further ones, as sbatch takes them: "--qos=low"
  int array_tasks = 200;                    ///< that wait or run at a time, >= 1
  double task_s = 300.0;                    ///< an array task is given runs for about so long [s], > 0
  double poll_s = 2.0;                      ///< interval between polls of the queue and the files [s], > 0
};

/// The configuration is wrong; the message names the file and every fault.
struct SlurmConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads a JSON object with any of the members above as keys.
/// @throws SlurmConfigError
SlurmConfig read_slurm_config(const std::filesystem::path& file);

/// The same from its text. @param place  stands before each fault
SlurmConfig parse_slurm_config(const std::string& text, const std::string& place);

}  // namespace talus::executor

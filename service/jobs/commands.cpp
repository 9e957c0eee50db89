#include "jobs/commands.hpp"

#include <cstdlib>

#include "base/json.hpp"
#include "support/run_memory.hpp"

namespace talus::service {
namespace {

constexpr std::uint64_t short_command_memory = std::uint64_t{4} << 30;
constexpr double reserve = 6.0;  ///< address space of a run's data, as a multiple of the memory that it takes
constexpr std::uint64_t stall_seconds = 60;  ///< a run that uses no CPU time for so long hangs
constexpr double reserved_always = 2e9;      ///< address space of the program, its libraries and thread stacks [bytes]

/// The whole environment of a command. The variables of talusd that are passed on affect only how it computes or
/// reports.
std::vector<std::string> environment(int threads) {
  std::vector<std::string> all = {"PATH=/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8", "TZ=UTC",
                                  "OMP_NUM_THREADS=" + std::to_string(threads), "OMP_WAIT_POLICY=passive"};
  for (const char* name : {"TALUS_SIMD", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) all.push_back(std::string(name) + "=" + value);
  return all;
}

executor::Limits run_limits(const Config& config, double particles) {
  const auto seconds = static_cast<std::uint64_t>(config.time_limit.count());
  const double from_size = particles > 0.0 ? reserved_always + reserve * run_memory(particles) : 0.0;
  return {.memory_bytes = config.memory_bytes.value_or(static_cast<std::uint64_t>(from_size)),
          .cpu_seconds = seconds * static_cast<std::uint64_t>(config.threads) + 60,
          .file_bytes = config.file_bytes,
          .wall_seconds = seconds,
          .stall_seconds = stall_seconds,
          .core_dumps = false};
}

}  // namespace

Command short_command(const Config& config, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), config.program.string());
  const bool limited = config.memory_bytes != 0;
  return {.arguments = std::move(arguments),
          .environment = environment(1),
          .limits = {.memory_bytes = limited ? short_command_memory : 0,
                     .cpu_seconds = 120,
                     .file_bytes = config.file_bytes,
                     .core_dumps = false}};
}

Command single_run(const Config& config, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {config.program.string(), "run"});
  arguments.insert(arguments.end(), {"--threads", std::to_string(config.threads), "--study-worker"});
  return {.arguments = std::move(arguments),
          .environment = environment(config.threads),
          .limits = run_limits(config, 0.0),
          .niceness = config.niceness};
}

Command study_run(const Config& config, const StudyInfo& study, const RunKey& key, double particles) {
  return {.arguments = run_arguments({config.program.string(), "run"}, study, key, config.threads),
          .environment = environment(config.threads),
          .limits = run_limits(config, particles),
          .niceness = config.niceness};
}

void log_failure(const CommandOutput& output) {
  log_error("talus_failed", {{"exit_code", output.end.exit_code}, {"signal", output.end.signal}, {"said", output.err}});
}

}  // namespace talus::service

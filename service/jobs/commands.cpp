#include "jobs/commands.hpp"

#include <cstdlib>

#include "support/run_memory.hpp"

namespace talus::service {
namespace {

constexpr std::uint64_t short_command_memory = std::uint64_t{4} << 30;
constexpr double reserve = 6.0;          ///< address space of a run's data, as a multiple of the memory that it takes
constexpr double reserved_always = 2e9;  ///< address space of the program, its libraries and thread stacks [bytes]

/// The whole environment of a command. The variables of talusd that are passed on affect only how it computes or
/// reports.
std::vector<std::string> environment(int threads) {
  std::vector<std::string> all = {"PATH=/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8", "TZ=UTC",
                                  "OMP_NUM_THREADS=" + std::to_string(threads), "OMP_WAIT_POLICY=passive"};
  for (const char* name : {"TALUS_SIMD", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) all.push_back(std::string(name) + "=" + value);
  return all;
}

}  // namespace

Command Commands::short_command(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), config_.program.string());
  const bool limited = config_.memory_bytes != 0;
  return {.arguments = std::move(arguments),
          .environment = environment(1),
          .limits = {.memory_bytes = limited ? short_command_memory : 0,
                     .cpu_seconds = 120,
                     .file_bytes = config_.file_bytes,
                     .core_dumps = false}};
}

executor::Limits Commands::run_limits(double particles) const {
  const auto seconds = static_cast<std::uint64_t>(config_.time_limit.count());
  const double from_size = particles > 0.0 ? reserved_always + reserve * run_memory(particles) : 0.0;
  return {.memory_bytes = config_.memory_bytes.value_or(static_cast<std::uint64_t>(from_size)),
          .cpu_seconds = seconds * static_cast<std::uint64_t>(config_.threads) + 60,
          .file_bytes = config_.file_bytes,
          .wall_seconds = seconds,
          .core_dumps = false};
}

/// A run outside the queue; its size is not known here, so only --memory limits it.
Command Commands::long_run(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), config_.program.string());
  arguments.insert(arguments.end(), {"--threads", std::to_string(config_.threads), "--study-worker"});
  return {.arguments = std::move(arguments),
          .environment = environment(config_.threads),
          .limits = run_limits(0.0),
          .niceness = config_.niceness};
}

Command Commands::validate(const std::filesystem::path& case_file) const {
  return short_command({"validate", case_file.string(), "--json"});
}

Command Commands::prepare(const std::filesystem::path& case_file, const StudyPaths& study, std::int64_t realizations,
                          std::int64_t seed) const {
  return short_command({"study", case_file.string(), "--out", study.root.string(), "--realizations",
                        std::to_string(realizations), "--seed", std::to_string(seed), "--prepare"});
}

Command Commands::run(const StudyInfo& study, const RunKey& key, double particles) const {
  return {.arguments = run_arguments({config_.program.string(), "run"}, study, key, config_.threads),
          .environment = environment(config_.threads),
          .limits = run_limits(particles),
          .niceness = config_.niceness};
}

Command Commands::replay(const StudyPaths& study, const RunKey& run, std::int64_t seed,
                         const std::filesystem::path& out) const {
  return long_run({"run", study.resolved_case().string(), "--realization", std::to_string(run.index), "--seed",
                   std::to_string(seed), "--out", out.string()});
}

Command Commands::median(const std::filesystem::path& case_file, const std::filesystem::path& out) const {
  return long_run({"run", case_file.string(), "--seed", "0", "--out", out.string()});
}

Command Commands::field(const StudyPaths& study, const RunKey& run, std::int64_t seed,
                        const std::filesystem::path& out) const {
  return short_command({"field", study.resolved_case().string(), "--realization", std::to_string(run.index), "--seed",
                        std::to_string(seed), "--out", out.string(), "--json"});
}

Command Commands::profile(const std::filesystem::path& run_directory, const std::filesystem::path& out) const {
  return short_command({"profile", run_directory.string(), "--out", out.string()});
}

}  // namespace talus::service

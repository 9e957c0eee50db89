#include "jobs/commands.hpp"

#include <cstdlib>

#include "support/run_memory.hpp"

namespace talus::service {
namespace {

constexpr std::uint64_t quick_memory = std::uint64_t{4} << 30;
constexpr double reserve = 6.0;          ///< address space of a run's data, as a multiple of the memory that it takes
constexpr double reserved_always = 2e9;  ///< address space of the program, its libraries and thread stacks [bytes]

/// Nothing of ours but what a run needs; the last few decide only how it computes or reports.
std::vector<std::string> environment(int threads) {
  std::vector<std::string> all = {"PATH=/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8", "TZ=UTC",
                                  "OMP_NUM_THREADS=" + std::to_string(threads), "OMP_WAIT_POLICY=passive"};
  for (const char* name : {"TALUS_SIMD", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) all.push_back(std::string(name) + "=" + value);
  return all;
}

}  // namespace

Command Commands::quick(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), config_.program.string());
  Command command{.arguments = std::move(arguments), .environment = environment(1)};
  command.limits.core_dumps = false;
  if (config_.memory_limit != Config::MemoryLimit::none) command.limits.memory_bytes = quick_memory;
  command.limits.cpu_seconds = 120;
  command.limits.file_bytes = config_.file_bytes;
  return command;
}

Limits Commands::run_limits(double particles) const {
  Limits limits;
  if (config_.memory_limit == Config::MemoryLimit::fixed) limits.memory_bytes = config_.memory_bytes;
  if (config_.memory_limit == Config::MemoryLimit::by_size)
    limits.memory_bytes = static_cast<std::uint64_t>(reserved_always + reserve * run_memory(particles));
  limits.cpu_seconds =
      static_cast<std::uint64_t>(config_.time_limit.count()) * static_cast<std::uint64_t>(config_.threads) + 60;
  limits.file_bytes = config_.file_bytes;
  limits.wall_seconds = static_cast<std::uint64_t>(config_.time_limit.count());
  limits.core_dumps = false;
  return limits;
}

/// A run outside the queue.
Command Commands::heavy(std::vector<std::string> arguments) const {
  Command command = quick(std::move(arguments));
  command.limits = run_limits(0.0);
  const bool fixed = config_.memory_limit == Config::MemoryLimit::fixed;
  command.limits.memory_bytes = fixed ? config_.memory_bytes : 0;
  command.environment = environment(config_.threads);
  command.niceness = config_.niceness;
  return command;
}

Command Commands::validate(const std::filesystem::path& case_file) const {
  return quick({"validate", case_file.string(), "--json"});
}

Command Commands::prepare(const std::filesystem::path& case_file, const StudyPaths& study, std::int64_t realizations,
                          std::int64_t seed) const {
  return quick({"study", case_file.string(), "--out", study.root.string(), "--realizations",
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
  return heavy({"run", study.resolved_case().string(), "--realization", std::to_string(run.index), "--seed",
                std::to_string(seed), "--threads", std::to_string(config_.threads), "--out", out.string(),
                "--study-worker"});
}

Command Commands::median(const std::filesystem::path& case_file, const std::filesystem::path& out) const {
  return heavy({"run", case_file.string(), "--seed", "0", "--threads", std::to_string(config_.threads), "--out",
                out.string(), "--study-worker"});
}

Command Commands::field(const StudyPaths& study, const RunKey& run, std::int64_t seed,
                        const std::filesystem::path& out) const {
  return quick({"field", study.resolved_case().string(), "--realization", std::to_string(run.index), "--seed",
                std::to_string(seed), "--out", out.string(), "--json"});
}

Command Commands::profile(const std::filesystem::path& run_directory, const std::filesystem::path& out) const {
  return quick({"profile", run_directory.string(), "--out", out.string()});
}

}  // namespace talus::service

#pragma once
// Every command line that talusd starts. They are built from internal paths and numbers, never from text of a request.

#include <filesystem>
#include <optional>
#include <vector>

#include "executor/process.hpp"
#include "jobs/config.hpp"
#include "study/engine.hpp"

namespace talus::service {

using executor::Command;

class Commands {
 public:
  explicit Commands(const Config& config) : config_(config) {}

  Command validate(const std::filesystem::path& case_file) const;
  /// Makes `study` the directory of a study, or extends the study in it.
  Command prepare(const std::filesystem::path& case_file, const StudyPaths& study, std::int64_t realizations,
                  std::int64_t seed) const;
  /// @param particles  of the case: the memory limit follows from them
  Command run(const StudyInfo& study, const RunKey& key, double particles) const;
  /// The same realization into another directory, with its snapshots.
  Command replay(const StudyPaths& study, const RunKey& run, std::int64_t seed, const std::filesystem::path& out) const;
  /// A run with the coefficients of its random field given in the case, for UM-Bridge.
  Command median(const std::filesystem::path& case_file, const std::filesystem::path& out) const;
  Command field(const StudyPaths& study, const RunKey& run, std::int64_t seed, const std::filesystem::path& out) const;
  /// @param out  ends in .json or .svg
  Command profile(const std::filesystem::path& run_directory, const std::filesystem::path& out) const;

 private:
  Command short_command(std::vector<std::string> arguments) const;
  Command long_run(std::vector<std::string> arguments) const;
  executor::Limits run_limits(double particles) const;
  const Config& config_;
};

}  // namespace talus::service

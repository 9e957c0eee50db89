#pragma once
// How talusd starts `talus`: program, environment and limits. Arguments are internal paths and numbers, never text of a
// request. All functions are thread-safe.

#include <chrono>
#include <string>
#include <vector>

#include "executor/process.hpp"
#include "jobs/config.hpp"
#include "process/short_command.hpp"
#include "study/engine.hpp"

namespace talus::service {

using executor::Command;

/// Of a short command.
inline constexpr std::chrono::seconds command_limit{60};

/// A command that ends within seconds.
Command short_command(const Config& config, std::vector<std::string> arguments);

/// `talus run ARGUMENTS` outside the queue. Its size is not known, so of the limits of memory only --memory applies.
Command single_run(const Config& config, std::vector<std::string> arguments);

/// A run of a study.
/// @param particles  of the case: the memory limit follows from them
Command study_run(const Config& config, const StudyInfo& study, const RunKey& key, double particles);

/// Says in the log how a command failed.
void log_failure(const CommandOutput& output);

}  // namespace talus::service

#pragma once
// The verbs of the command line: each adds its subcommand and, once chosen, sets the action to carry out.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "support/error.hpp"

namespace talus::cli {

/// "0.1.0"
inline const std::string version = TALUS_VERSION;

/// What the chosen verb does; may throw ConfigError, DivergedError, IoError (main maps them to exit codes).
using Action = std::function<Exit()>;

void add_validate(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_field(CLI::App& app, Action& action);
void add_study(CLI::App& app, Action& action);
void add_stats(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_plot(CLI::App& app, Action& action);
void add_schema(CLI::App& app, Action& action);
void add_profile(CLI::App& app, Action& action);
void add_remote(CLI::App& app, Action& action);  ///< submit, status, watch, results, cancel
void add_array_task(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);

}  // namespace talus::cli

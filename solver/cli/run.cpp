#include "cli/verbs.hpp"

namespace talus::cli {

void add_run(CLI::App& app, Action&) { app.add_subcommand("run"); }

}  // namespace talus::cli

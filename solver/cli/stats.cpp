#include "cli/verbs.hpp"

namespace talus::cli {

void add_stats(CLI::App& app, Action&) { app.add_subcommand("stats"); }

}  // namespace talus::cli

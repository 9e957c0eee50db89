#include "cli/verbs.hpp"

namespace talus::cli {

void add_study(CLI::App& app, Action&) { app.add_subcommand("study"); }

}  // namespace talus::cli

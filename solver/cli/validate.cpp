#include "cli/verbs.hpp"

namespace talus::cli {

void add_validate(CLI::App& app, Action&) { app.add_subcommand("validate"); }

}  // namespace talus::cli

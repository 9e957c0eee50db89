#include "cli/verbs.hpp"

namespace talus::cli {

void add_field(CLI::App& app, Action&) { app.add_subcommand("field"); }

}  // namespace talus::cli

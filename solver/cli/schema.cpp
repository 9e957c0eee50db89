#include "cli/verbs.hpp"

namespace talus::cli {

void add_schema(CLI::App& app, Action&) { app.add_subcommand("schema"); }

}  // namespace talus::cli

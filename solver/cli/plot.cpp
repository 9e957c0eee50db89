#include "cli/verbs.hpp"

namespace talus::cli {

void add_plot(CLI::App& app, Action&) { app.add_subcommand("plot"); }

}  // namespace talus::cli

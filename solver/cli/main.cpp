// talus: one file per subcommand; errors become exit codes here and nowhere else.

#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "cli/help.hpp"
#include "cli/runtime_settings.hpp"
#include "cli/verbs.hpp"
#include "cli/version.hpp"
#include "sph/pair_loops.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

int report(talus::Exit code, const std::string& text) {
  std::cerr << text << (text.ends_with('\n') ? "" : "\n");
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  using talus::Exit;
  talus::cli::settle_runtime(argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error with a message, not a sudden death
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // what large arrays no longer need goes back to the system
#endif
  CLI::App app{"Talus: run-out of landslides and its uncertainty", "talus"};
  app.set_version_flag("--version", talus::cli::version_text(), "Print the version and exit");
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 ok, 1 internal error, 2 usage, 3 bad case, 4 diverged, 5 input/output, 6 stopped, can be resumed, "
      "7 too many failed runs");
  if (const char* simd = std::getenv("TALUS_SIMD"); simd && *simd && !talus::limit_pair_loops(simd))
    return report(Exit::usage, "TALUS_SIMD must be AVX2 or SSE4, or unset for the best that the processor supports");
  talus::cli::Action action;
  talus::cli::add_validate(app, action);
  talus::cli::add_field(app, action);
  talus::cli::add_run(app, action);
  talus::cli::add_profile(app, action);
  talus::cli::add_study(app, action);
  talus::cli::add_stats(app, action);
  talus::cli::add_plot(app, action);
  talus::cli::add_schema(app, action);
  talus::cli::add_bench(app, action);
  talus::cli::add_remote(app, action);
  talus::cli::add_array_task(app, action);
  talus::cli::format_help(app);
  const std::vector<std::string> arguments = talus::cli::normalized({argv + 1, argv + argc});
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& e) {
    if (talus::cli::asks_for_help(app, arguments, e)) return app.exit(e);
    return report(Exit::usage, talus::cli::usage_message(app, arguments, e));
  }
  try {
    return action ? static_cast<int>(action()) : static_cast<int>(Exit::usage);
  } catch (const talus::ConfigError& e) {
    return report(Exit::bad_case, e.what());
  } catch (const talus::DivergedError& e) {
    return report(Exit::diverged, e.what());
  } catch (const talus::IoError& e) {
    return report(Exit::io, e.what());
  } catch (const std::exception& e) {
    return report(Exit::internal, std::string("internal error: ") + e.what());
  }
}

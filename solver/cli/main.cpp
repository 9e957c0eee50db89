// talus: one file per subcommand; errors become exit codes here and nowhere else.

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "sph/pair_loops.hpp"
#include "support/standard_output.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using talus::Exit;
using namespace talus::cli;

/// Starts the program over, once, with the settings that its libraries read before main() and that nobody has chosen
/// yet; returns if there is nothing to set, or if the system does not let it.
/// - GOMP_SPINCOUNT: threads of GNU OpenMP wait for each other actively for milliseconds by default. That is right on
///   an idle machine; beside other programs a run on all cores became thirty times slower.
/// - GLIBC_TUNABLES: large pages for large arrays.
void settle_runtime(char** argv) {
  const bool spins = std::getenv("GOMP_SPINCOUNT") == nullptr && std::getenv("OMP_WAIT_POLICY") == nullptr;
  const bool small_pages = std::getenv("GLIBC_TUNABLES") == nullptr;
  if (!spins && !small_pages) return;
  std::error_code failed;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return;
  if (spins) setenv("GOMP_SPINCOUNT", "5000", 0);
  if (small_pages) setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 0);
  execv(program.c_str(), argv);
}

int report(Exit code, const std::string& text) {
  std::cerr << text << (text.ends_with('\n') ? "" : "\n");
  return static_cast<int>(code);
}

/// The program, but for the check of its output. @return the exit code
int run_program(int argc, char** argv) {
  settle_runtime(argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error with a message, not a sudden death
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // what large arrays no longer need goes back to the system
#endif
  CLI::App app{"Talus: run-out of landslides and its uncertainty", "talus"};
  app.set_version_flag("--version",
                       "talus " + version + "\ncompiler: " + TALUS_COMPILER +
                           "\npair loops: " + talus::pair_loops_target() + " on this processor, chosen at run time",
                       "Print the version and exit");
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 ok, 1 internal error, 2 usage, 3 bad case, 4 diverged, 5 input/output, 6 stopped, can be resumed, "
      "7 too many failed runs");
  if (const char* simd = std::getenv("TALUS_SIMD"); simd && *simd && !talus::limit_pair_loops(simd))
    return report(Exit::usage, "TALUS_SIMD must be AVX2 or SSE4, or unset for the best that the processor supports");
  Action action;
  for (const auto add : {add_validate, add_field, add_run, add_profile, add_study, add_stats, add_compare, add_plot,
                         add_schema, add_bench, add_remote, add_array_task})
    add(app, action);
  format_help(app);
  const std::vector<std::string> arguments = normalized({argv + 1, argv + argc});
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& e) {
    if (asks_for_help(app, arguments, e)) return app.exit(e);
    return report(Exit::usage, usage_message(app, arguments, e));
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

}  // namespace

int main(int argc, char** argv) { return talus::checked_output(run_program(argc, argv), "talus"); }

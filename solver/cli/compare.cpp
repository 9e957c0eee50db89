// talus compare: two studies on the same draws, judged pair by pair.

#include "study/compare.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/help.hpp"
#include "cli/verbs.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_case_bytes = std::size_t{1} << 30;

struct CompareOptions {
  fs::path a, b;
  bool json = false;
};

Exit compare(const CompareOptions& options) {
  const auto case_of = [](const fs::path& directory) {
    return read_json(StudyPaths{directory}.resolved_case(), max_case_bytes);
  };
  const Json all = comparison(read_tables(options.a), read_tables(options.b), case_of(options.a), case_of(options.b));
  std::cout << (options.json ? all.dump(2) + "\n" : comparison_text(all));
  return Exit::ok;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = app.add_subcommand(
      "compare",
      "Compare two studies on the same draws, realization by realization, for example with and without a barrier");
  verb->add_option("A", options->a, "Directory of a study")->type_name("DIR")->required();
  verb->add_option("B", options->b, "Directory of the study to compare with it: the same seed and random field")
      ->type_name("DIR")
      ->required();
  verb->add_flag("--json", options->json, "Print the comparison as JSON");
  set_footer(*verb, {exit_text::bad_case, exit_text::io}, {"compare without with", "compare without with --json"});
  verb->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace talus::cli

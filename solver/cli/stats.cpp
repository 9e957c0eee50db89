// talus stats: study.json again from the tables of one study, or of several machines' shares of one.

#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/verbs.hpp"
#include "io/files.hpp"
#include "study/progress.hpp"
#include "study/publish.hpp"
#include "study/summary.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct StatsOptions {
  std::vector<fs::path> directories;
  fs::path out;
  bool json = false;
};

Exit stats(const StatsOptions& options) {
  if (options.directories.size() > 1 && options.out.empty()) {
    std::cerr << "several studies are merged into a new directory: give --out DIR\n";
    return Exit::usage;
  }
  Tables tables = merge(options.directories);
  tables.runs = counted(tables.plan, tables.runs);
  const nlohmann::ordered_json study = summarize(tables.plan, tables.runs, tables.floor);
  const std::string text = study.dump(2) + "\n";
  if (options.out.empty())
    write_file_atomically(StudyPaths{options.directories.front()}.summary(), text);
  else
    write_merged(options.out, tables, options.directories.front());
  if (options.json)
    std::cout << text;
  else
    std::cout << summary_table(study) << "\ninfluence zone [m]\n"
              << text_histogram(study.at("quantities").at("influence_zone_m"), 80);
  return Exit::ok;
}

}  // namespace

void add_stats(CLI::App& app, Action& action) {
  auto options = std::make_shared<StatsOptions>();
  CLI::App* verb = app.add_subcommand(
      "stats", "study.json again from realizations.csv; several directories of one study are merged into --out");
  verb->add_option("directories", options->directories, "directories of studies with the same case and seed")
      ->required();
  verb->add_option("--out", options->out, "directory for the merged study");
  verb->add_flag("--json", options->json, "print study.json on stdout");
  verb->callback([options, &action] { action = [options] { return stats(*options); }; });
}

}  // namespace talus::cli

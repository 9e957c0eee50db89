// talus stats: study.json again from the tables of one study, or of several machines' shares of one; or one quantity of
// it with other bins.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/help.hpp"
#include "cli/progress.hpp"
#include "cli/verbs.hpp"
#include "study/directory_store.hpp"
#include "study/publish.hpp"
#include "study/summary.hpp"
#include "support/files.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

constexpr int most_bins = 10000;

struct StatsOptions {
  std::vector<fs::path> directories;
  fs::path out;
  std::string quantity;
  int bins = 0;
  std::vector<double> edges;
  bool from_runs = false, json = false;
};

/// The records of a study whose realizations others have run: from the results in its runs/ and floor/.
Tables tables_from_runs(const fs::path& directory) {
  std::optional<Plan> plan = find_plan(directory);
  if (!plan) throw IoError(directory.string() + " does not hold a study: there is no plan.json");
  const auto records = [&](RunKind kind) {
    std::vector<Record> all;
    for (auto& [index, record] : read_records({directory}, kind, identity(*plan))) all.push_back(std::move(record));
    return all;
  };
  return {.plan = *plan, .runs = records(RunKind::realization), .floor = records(RunKind::replicate)};
}

/// What cannot be asked for together; empty if all is well.
std::string misuse(const StatsOptions& options) {
  if (options.directories.size() > 1 && options.from_runs) return "--from-runs takes one directory";
  if (options.directories.size() > 1 && options.out.empty())
    return "several studies are merged into a new directory: give --out DIR";
  if (options.quantity.empty() && (options.bins > 0 || !options.edges.empty()))
    return "--bins and --edges go with --quantity";
  if (!std::ranges::all_of(options.edges, [](double edge) { return std::isfinite(edge); }))
    return "--edges must be finite numbers";
  if (!options.edges.empty() &&
      (options.edges.size() < 2 || !std::is_sorted(options.edges.begin(), options.edges.end()) ||
       std::adjacent_find(options.edges.begin(), options.edges.end()) != options.edges.end()))
    return "--edges must be at least two increasing numbers";
  return {};
}

/// Tables without a directory of runs would be those of a merged study, which cannot go on.
void write_prepared(const StudyPaths& paths, const Tables& tables) {
  std::error_code error;
  std::filesystem::create_directories(paths.runs(), error);
  if (error) throw_io_error("create", paths.runs(), error.value());
  write_tables(paths, tables.plan, tables.runs, tables.floor);
}

Exit stats(const StatsOptions& options) {
  if (const std::string wrong = misuse(options); !wrong.empty()) {
    std::cerr << wrong << "\n";
    return Exit::usage;
  }
  const fs::path& first = options.directories.front();
  const Tables tables = options.from_runs ? tables_from_runs(first) : merge(options.directories);
  const StudySummary summary = summary_of(tables.plan, tables.runs, tables.floor);
  if (!options.quantity.empty()) {  // a question only: nothing is written
    const Measure& measure = *find_measure(options.quantity);
    const Bins bins{.count = static_cast<std::size_t>(options.bins), .edges = options.edges};
    std::cout << distribution(tables.plan, measure, summary.sample(measure), bins).dump(2) << "\n";
    return Exit::ok;
  }
  const Json study = summary.json();
  const std::string text = with_checksum(study);
  if (!options.out.empty())
    write_merged(options.out, tables, first);
  else if (options.from_runs)
    write_prepared({first}, tables);
  else
    write_file_atomically(StudyPaths{first}.summary(), text);
  std::cout << (options.json ? text : study_report(study));
  return Exit::ok;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const Measure& measure : measure_table) names.emplace_back(measure.key);
  return names;
}

}  // namespace

void add_stats(CLI::App& app, Action& action) {
  auto options = std::make_shared<StatsOptions>();
  CLI::App* verb = app.add_subcommand(
      "stats", "Recompute study.json from realizations.csv; several directories of one study are merged into --out");
  verb->add_option("DIR", options->directories, "Directories of studies with the same case and seed")
      ->type_name("DIR...")
      ->required();
  verb->add_option("--out", options->out, "Directory for the merged study")->type_name("DIR");
  verb->add_flag("--from-runs", options->from_runs, "First write the tables from the results in runs/");
  verb->add_option("--quantity", options->quantity, "Only print the distribution of this measure, as JSON")
      ->type_name("KEY")
      ->check(CLI::IsMember(quantity_names()));
  auto* bins = verb->add_option("--bins", options->bins, "With --quantity: number of equal bins")
                   ->check(CLI::Range(1, most_bins));
  verb->add_option("--edges", options->edges, "With --quantity: edges of the bins, separated by commas")
      ->delimiter(',')
      ->excludes(bins);
  verb->add_flag("--json", options->json, "Print study.json on stdout");
  set_footer(*verb, {exit_text::bad_case, exit_text::io},
             {"stats study --quantity front_mass_99_m --bins 20", "stats here there --out both"});
  verb->callback([options, &action] { action = [options] { return stats(*options); }; });
}

}  // namespace talus::cli

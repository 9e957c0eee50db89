// talus stats: study.json again from the tables of one study, or of several machines' shares of one; or one quantity of
// it with other bins.

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/verbs.hpp"
#include "io/files.hpp"
#include "monte_carlo/histogram.hpp"
#include "study/ledger.hpp"
#include "study/progress.hpp"
#include "study/publish.hpp"
#include "study/summary.hpp"

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

/// The books of a study whose realizations others have run: from the results in its runs/ and floor/.
Tables tables_from_runs(const fs::path& directory) {
  std::optional<Plan> plan = find_plan(directory);
  if (!plan) throw IoError(directory.string() + " does not hold a study: there is no plan.json");
  const Ledger ledger(StudyPaths{directory}, *plan);
  return {.plan = std::move(*plan), .runs = ledger.runs(), .floor = ledger.floor()};
}

/// How one quantity is distributed, in the bins asked for.
nlohmann::ordered_json distribution(const nlohmann::ordered_json& study, const Tables& tables,
                                    const StatsOptions& options) {
  const auto column = std::find_if(measure_columns.begin(), measure_columns.end(),
                                   [&](const MeasureColumn& c) { return c.key == options.quantity; });
  std::vector<double> sample;
  for (const Record& r : tables.runs)
    if (r.done) sample.push_back(r.measures.*column->member);
  std::sort(sample.begin(), sample.end());

  const nlohmann::ordered_json& quantity = study.at("quantities").at(options.quantity);
  const nlohmann::ordered_json& realizations = study.at("realizations");
  nlohmann::ordered_json out = {{"quantity", options.quantity}};
  for (const char* key : {"planned", "done", "failed", "complete"}) out[key] = realizations.at(key);
  for (const char* key :
       {"n", "mean", "mean_ci95", "stdev", "min", "max", "noise_floor_stdev", "stdev_over_noise_floor"})
    out[key] = quantity.at(key);
  out["histogram"] = quantity.at("histogram");
  if (options.bins == 0 && options.edges.empty()) return out;
  const std::vector<double> edges =
      options.edges.empty() ? equal_edges(sample, static_cast<std::size_t>(options.bins)) : options.edges;
  const Histogram h = edges.empty() ? Histogram{} : histogram(sample, edges);
  out["histogram"] = {{"edges", h.edges},
                      {"counts", h.counts},
                      {"underflow", h.underflow},
                      {"overflow", h.overflow},
                      {"convention", histogram_convention},
                      {"edges_given", !options.edges.empty()}};
  return out;
}

/// What cannot be asked for together; empty if all is well.
std::string misuse(const StatsOptions& options) {
  if (options.directories.size() > 1 && options.from_runs) return "--from-runs takes one directory";
  if (options.directories.size() > 1 && options.out.empty())
    return "several studies are merged into a new directory: give --out DIR";
  if (options.quantity.empty() && (options.bins > 0 || !options.edges.empty()))
    return "--bins and --edges go with --quantity";
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

void publish(const StatsOptions& options, const Tables& tables, const std::string& study) {
  const StudyPaths paths{options.directories.front()};
  if (!options.out.empty())
    write_merged(options.out, tables, options.directories.front());
  else if (options.from_runs)
    write_prepared(paths, tables);
  else
    write_file_atomically(paths.summary(), study);
}

Exit stats(const StatsOptions& options) {
  if (const std::string wrong = misuse(options); !wrong.empty()) {
    std::cerr << wrong << "\n";
    return Exit::usage;
  }
  Tables tables = options.from_runs ? tables_from_runs(options.directories.front()) : merge(options.directories);
  tables.runs = counted(tables.plan, tables.runs);
  const nlohmann::ordered_json study = summarize(tables.plan, tables.runs, tables.floor);
  if (!options.quantity.empty()) {  // a question only: nothing is written
    std::cout << distribution(study, tables, options).dump(2) << "\n";
    return Exit::ok;
  }
  const std::string text = study.dump(2) + "\n";
  publish(options, tables, text);
  if (options.json)
    std::cout << text;
  else
    std::cout << summary_table(study) << "\ninfluence zone [m]\n"
              << text_histogram(study.at("quantities").at("influence_zone_m"), 80);
  return Exit::ok;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const MeasureColumn& column : measure_columns) names.emplace_back(column.key);
  return names;
}

}  // namespace

void add_stats(CLI::App& app, Action& action) {
  auto options = std::make_shared<StatsOptions>();
  CLI::App* verb = app.add_subcommand(
      "stats", "study.json again from realizations.csv; several directories of one study are merged into --out");
  verb->add_option("directories", options->directories, "directories of studies with the same case and seed")
      ->required();
  verb->add_option("--out", options->out, "directory for the merged study");
  verb->add_flag("--from-runs", options->from_runs, "write the tables from the results in runs/ first");
  verb->add_option("--quantity", options->quantity, "only print how this one is distributed, as JSON")
      ->check(CLI::IsMember(quantity_names()));
  auto* bins =
      verb->add_option("--bins", options->bins, "with --quantity: so many equal bins")->check(CLI::Range(1, most_bins));
  verb->add_option("--edges", options->edges, "with --quantity: edges of the bins, separated by commas")
      ->delimiter(',')
      ->excludes(bins);
  verb->add_flag("--json", options->json, "print study.json on stdout");
  verb->callback([options, &action] { action = [options] { return stats(*options); }; });
}

}  // namespace talus::cli

// talus stats: study.json again from the tables of one study, or of several machines' shares of one; or one quantity of
// it with other bins.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/progress.hpp"
#include "cli/verbs.hpp"
#include "run/drawn_numbers.hpp"
#include "study/directory_store.hpp"
#include "study/publish.hpp"
#include "study/summary.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

constexpr int most_bins = 10000;

struct StatsOptions {
  std::vector<fs::path> directories;
  fs::path out;
  std::string quantity;
  std::vector<std::string> at;
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
  if (!options.at.empty() && (options.bins > 0 || !options.edges.empty())) return "--at does not go with bins";
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

/// What the realizations drew, from the case, where the plan is of a version that did not write it down. Without the
/// case, or with one that this version reads otherwise, it stays unknown.
void find_draws(Plan& plan, const fs::path& directory) try {
  if (!plan.draws.empty()) return;
  add_missing_draws(plan, load_case(StudyPaths{directory}.resolved_case()));
} catch (const std::runtime_error&) {
}

constexpr std::string_view name_prefix = "name=";

/// The places of --at: a distance, or name=TARGET. Nothing and a message on stderr where one is neither.
std::optional<Json> answers(const StatsOptions& options, const Plan& plan, const StudySummary& summary) {
  Json all = Json::array();
  const std::string asked = options.quantity.empty() ? leading_measure.key : options.quantity;
  for (const std::string& at : options.at) {
    const bool by_name = at.starts_with(name_prefix);
    const std::optional<double> x = by_name ? std::optional(0.0) : to_number(at);
    const std::string name = by_name ? at.substr(name_prefix.size()) : asked;
    const std::optional<StudyQuantity> of = find_quantity(name, plan.targets);
    if (!x || !of || (by_name && (!of->target || of->number))) {
      std::vector<std::string> names;
      for (const TargetName& target : plan.targets) names.push_back(target.name);
      std::cerr << "--at " << at << " is neither a number nor name=TARGET with a target of this study"
                << (names.empty() ? "; it has no targets" : suggestion(name, names)) << "\n";
      return std::nullopt;
    }
    all.push_back(of->measure ? exceedance_at(*of->measure, summary.sample(*of->measure), *x)
                              : exceedance_at(summary.target_sample(*of->target), of->number, *x));
  }
  return all;
}

/// Probabilities, one a line, or as JSON.
Exit print_answers(const StatsOptions& options, const Plan& plan, const StudySummary& summary) {
  const std::optional<Json> all = answers(options, plan, summary);
  if (!all) return Exit::usage;
  if (options.json) std::cout << all->dump(2) << "\n";
  for (const Json& one : *all)
    if (!options.json) std::cout << one.at("sentence").get<std::string>() << "\n";
  return Exit::ok;
}

/// What is wrong with --quantity; empty if all is well.
std::string unknown_quantity(const StatsOptions& options, const Plan& plan) {
  if (options.quantity.empty()) return {};
  const std::optional<StudyQuantity> of = find_quantity(options.quantity, plan.targets);
  if (!of) return "--quantity " + options.quantity + suggestion(options.quantity, quantity_names(plan.targets));
  if (of->target && options.at.empty()) return "--quantity " + options.quantity + " goes with --at";
  return {};
}

Exit refuse(const std::string& why) {
  std::cerr << why << "\n";
  return Exit::usage;
}

Exit stats(const StatsOptions& options) {
  if (const std::string wrong = misuse(options); !wrong.empty()) return refuse(wrong);
  const fs::path& first = options.directories.front();
  Tables tables = options.from_runs ? tables_from_runs(first) : merge(options.directories);
  find_draws(tables.plan, first);
  const StudySummary summary = summary_of(tables.plan, tables.runs, tables.floor);
  if (const std::string wrong = unknown_quantity(options, tables.plan); !wrong.empty()) return refuse(wrong);
  if (!options.at.empty()) return print_answers(options, tables.plan, summary);  // a question only
  if (!options.quantity.empty()) {                                               // a question only: nothing is written
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
  verb->add_option("--quantity", options->quantity,
                   "Only print the distribution of this measure, as JSON; with --at also TARGET.NUMBER, for example "
                   "house.peak_depth_m")
      ->type_name("KEY");
  verb->add_option("--at", options->at,
                   "Only print the probability that the quantity exceeds X, with its 95 % interval; or, with "
                   "name=TARGET, that the slide reaches the target. May be repeated")
      ->type_name("X|name=TARGET")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  auto* bins = verb->add_option("--bins", options->bins, "With --quantity: number of equal bins")
                   ->check(CLI::Range(1, most_bins));
  verb->add_option("--edges", options->edges, "With --quantity: edges of the bins, separated by commas")
      ->delimiter(',')
      ->excludes(bins);
  verb->add_flag("--json", options->json, "Print study.json on stdout");
  set_footer(*verb, {exit_text::bad_case, exit_text::io},
             {"stats study --quantity front_mass_99_m --bins 20", "stats study --at 35 --at name=house",
              "stats here there --out both"});
  verb->callback([options, &action] { action = [options] { return stats(*options); }; });
}

}  // namespace talus::cli

// talus plot: draws the figures of a finished study or run from its files.

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "figures/figures.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct PlotOptions {
  fs::path directory;
  bool json = false;
};

std::vector<fs::path> draw(const fs::path& directory) {
  if (fs::exists(directory / "study.json")) return plot_study(directory);
  if (fs::exists(directory / "result.json")) return plot_run(directory);
  throw IoError(directory.string() +
                " contains neither study.json nor result.json; it is not the directory of a finished study or run");
}

Exit plot(const PlotOptions& options) {
  const std::vector<fs::path> figures = draw(options.directory);
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const fs::path& figure : figures) all.push_back(figure.string());
    std::cout << nlohmann::ordered_json{{"figures", all}}.dump(2) << "\n";
  } else {
    for (const fs::path& figure : figures) std::cout << figure.string() << "\n";
  }
  return Exit::ok;
}

}  // namespace

void add_plot(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* verb = app.add_subcommand("plot", "Draw the figures of a finished study or run into DIR/figures");
  verb->add_option("DIR", options->directory, "Directory of the study or run")->required();
  verb->add_flag("--json", options->json, "Print the paths as JSON");
  set_footer(*verb, {exit_text::bad_case, exit_text::io}, {"plot study"});
  verb->callback([options, &action] { action = [options] { return plot(*options); }; });
}

}  // namespace talus::cli

// talus profile: the final state of a run, as numbers or as a picture. talus plot: the figures of a finished study or
// run.

#include <cmath>
#include <iostream>
#include <memory>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "figures/figures.hpp"
#include "figures/profile.hpp"
#include "io/result_json.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
#include "support/files.hpp"
#include "support/json.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

struct ProfileOptions {
  fs::path directory, out;
};

/// The soil particles of a frame as columns.
Json columns(const Frame& frame) {
  Json x = Json::array(), y = x, moved = x, speed = x, phi = x;
  for (std::size_t i = 0; i < frame.n_soil; ++i) {
    x.push_back(frame.position[i].x + frame.origin.x);
    y.push_back(frame.position[i].y + frame.origin.y);
    moved.push_back(std::hypot(frame.displacement[i].x, frame.displacement[i].y));
    speed.push_back(std::hypot(frame.velocity[i].x, frame.velocity[i].y));
    phi.push_back(friction_angle_deg(frame.tan_phi[i]));
  }
  return {{"time_s", frame.time}, {"particles", frame.n_soil}, {"x_m", x}, {"y_m", y}, {"displacement_m", moved},
          {"speed_m_s", speed},   {"friction_angle_deg", phi}};
}

Exit profile(const ProfileOptions& options) {
  const fs::path snapshots = options.directory / "snapshots.vtkhdf";
  if (!fs::exists(snapshots))
    throw IoError(options.directory.string() + ": not the directory of a run: it has no snapshots.vtkhdf");
  const std::size_t n = snapshot_times(snapshots).size();
  if (n == 0) throw IoError(snapshots.string() + " contains no snapshot");
  const Frame frame = read_frame(snapshots, n - 1);
  if (options.out.extension() == ".json") {
    write_file_atomically(options.out, columns(frame).dump() + "\n");
  } else {
    const LoadedCase loaded = load_case(options.directory / "case.resolved.json");
    const Provenance from = read_result(options.directory / "result.json").second;
    std::string source = "Talus " + from.version + "  ·  seed " + std::to_string(from.seed);
    if (from.realization) source += "  ·  realization " + std::to_string(*from.realization);
    const figures::Snapshot shot{&frame, figures::Colour::displacement, {}};
    figures::plot_profiles({&shot, 1}, loaded.value.model.terrain, loaded.value.model.dx, options.out,
                           {from.case_title, "Displacement at the end", source + "  ·  case " + from.case_hash});
  }
  std::cout << options.out.string() << "\n";
  return Exit::ok;
}

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
    Json all = Json::array();
    for (const fs::path& figure : figures) all.push_back(figure.string());
    std::cout << Json{{"figures", all}}.dump(2) << "\n";
  } else {
    for (const fs::path& figure : figures) std::cout << figure.string() << "\n";
  }
  return Exit::ok;
}

}  // namespace

void add_profile(CLI::App& app, Action& action) {
  auto options = std::make_shared<ProfileOptions>();
  CLI::App* verb = app.add_subcommand("profile", "Write the final profile of a run as .json, .svg or .png");
  verb->add_option("DIR", options->directory, "Directory of a finished run")->required();
  verb->add_option("--out", options->out, "Output file; the format is taken from the extension")
      ->type_name("FILE")
      ->required()
      ->check(has_ending({".json", ".svg", ".png"}));
  set_footer(*verb, {exit_text::bad_case, exit_text::io},
             {"profile run --out deposit.svg", "profile run --out deposit.json"});
  verb->callback([options, &action] { action = [options] { return profile(*options); }; });
}

void add_plot(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* verb = app.add_subcommand("plot", "Draw the figures of a finished study or run into DIR/figures");
  verb->add_option("DIR", options->directory, "Directory of the study or run")->required();
  verb->add_flag("--json", options->json, "Print the paths as JSON");
  set_footer(*verb, {exit_text::bad_case, exit_text::io}, {"plot study"});
  verb->callback([options, &action] { action = [options] { return plot(*options); }; });
}

}  // namespace talus::cli

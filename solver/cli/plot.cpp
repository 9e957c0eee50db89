// talus profile: the final state of a run, as numbers or as a picture. talus plot: the figures of a finished study or
// run.

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "case/ground_report.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "figures/case_sheet.hpp"
#include "figures/figures.hpp"
#include "figures/ground.hpp"
#include "figures/profile.hpp"
#include "io/result_json.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
#include "simulation/particle_setup.hpp"
#include "support/files.hpp"
#include "support/json.hpp"
#include "support/text.hpp"

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
    const auto [result, from] = read_result(options.directory / "result.json");
    std::string source = "Talus " + from.version + "  ·  seed " + std::to_string(from.seed);
    if (from.realization) source += "  ·  realization " + std::to_string(*from.realization);
    const figures::Snapshot shot{&frame, figures::Colour::displacement, {}};
    figures::plot_profiles({&shot, 1}, loaded.value.model.terrain, loaded.value.model.dx, options.out,
                           {from.case_title, "Displacement at the end", source + "  ·  case " + from.case_hash,
                            verdict_lines(result.quality)},
                           {.structures = figures::structures_of(loaded.value.model)});
  }
  std::cout << options.out.string() << "\n";
  return Exit::ok;
}

struct PlotOptions {
  fs::path source;  ///< a directory of results or a case file
  std::optional<fs::path> out;
  bool walls = false, json = false;
};

/// The case before it is run, as CASE-ground.svg in the current directory unless `out` says otherwise.
std::vector<fs::path> draw_case(const PlotOptions& options) {
  const LoadedCase loaded = load_case(options.source);
  print_warnings(loaded.warnings);
  const GroundReport report = report_ground(loaded);
  const ParticlePlan plan = plan_particles(loaded.value.model);
  const fs::path out = options.out.value_or(options.source.stem().string() + "-ground.svg");
  const std::string subtitle = "Before the run: particle spacing " + to_text(loaded.value.model.dx) + " m, " +
                               std::to_string(plan.soil.size()) + " soil and " + std::to_string(plan.walls.size()) +
                               " wall particles";
  figures::case_sheet(loaded, report, {loaded.value.title, subtitle, "Talus " + version + "  ·  case " + loaded.hash},
                      options.walls)
      .save(out);
  return {out};
}

std::vector<fs::path> draw(const fs::path& directory) {
  if (fs::exists(directory / "study.json")) return plot_study(directory);
  if (fs::exists(directory / "result.json")) return plot_run(directory);
  throw IoError(directory.string() +
                " contains neither study.json nor result.json; it is not the directory of a finished study or run");
}

Exit plot(const PlotOptions& options) {
  const std::vector<fs::path> figures = fs::is_regular_file(options.source) ? draw_case(options) : draw(options.source);
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
  CLI::App* verb = app.add_subcommand("plot",
                                      "Draw the figures of a finished study or run into DIR/figures, or a case before "
                                      "it is run");
  verb->add_option("DIR", options->source, "Directory of the study or run, or a case file")->required();
  verb->add_option("--out", options->out, "Output file of a case; the format is taken from the extension")
      ->type_name("FILE")
      ->check(has_ending({".svg", ".png"}));
  verb->add_flag("--walls", options->walls, "Draw the wall particles of a case as well");
  verb->add_flag("--json", options->json, "Print the paths as JSON");
  set_footer(*verb, {exit_text::bad_case, exit_text::io}, {"plot study", "plot slope.json --out slope.svg"});
  verb->callback([options, &action] {
    if ((options->out || options->walls) && !fs::is_regular_file(options->source))
      throw CLI::ValidationError(
          "--out and --walls belong to the picture of a case; figures of a study or run go into DIR/figures");
    action = [options] { return plot(*options); };
  });
}

}  // namespace talus::cli

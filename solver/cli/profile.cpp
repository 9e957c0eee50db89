// talus profile: the final state of a run, as numbers or as a picture.

#include "figures/profile.hpp"

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/verbs.hpp"
#include "io/result_json.hpp"
#include "io/vtkhdf.hpp"
#include "math/angle.hpp"
#include "support/files.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct ProfileOptions {
  fs::path directory, out;
};

/// The soil particles of a frame as columns.
ordered_json columns(const Frame& frame) {
  ordered_json x = ordered_json::array(), y = x, moved = x, speed = x, phi = x;
  for (std::size_t i = 0; i < frame.n_soil; ++i) {
    x.push_back(frame.position[i].x);
    y.push_back(frame.position[i].y);
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

std::string known_ending(const std::string& path) {
  const fs::path ending = fs::path(path).extension();
  return ending == ".json" || ending == ".svg" || ending == ".png" ? "" : path + " must end in .json, .svg or .png";
}

}  // namespace

void add_profile(CLI::App& app, Action& action) {
  auto options = std::make_shared<ProfileOptions>();
  CLI::App* verb = app.add_subcommand("profile", "Write the final profile of a run as .json, .svg or .png");
  verb->add_option("DIR", options->directory, "Directory of a finished run")->required();
  verb->add_option("--out", options->out, "Output file; the format is taken from the extension")
      ->type_name("FILE")
      ->required()
      ->check(known_ending);
  set_footer(*verb, {exit_text::bad_case, exit_text::io},
             {"profile run --out deposit.svg", "profile run --out deposit.json"});
  verb->callback([options, &action] { action = [options] { return profile(*options); }; });
}

}  // namespace talus::cli

#include "figures/figures.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <set>
#include <span>
#include <string>

#include "case/load.hpp"
#include "figures/charts.hpp"
#include "figures/energy.hpp"
#include "figures/ground.hpp"
#include "figures/influence.hpp"
#include "figures/profile.hpp"
#include "io/history.hpp"
#include "io/result_json.hpp"
#include "io/vtkhdf.hpp"
#include "study/plan.hpp"
#include "study/record.hpp"
#include "support/error.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using namespace figures;

constexpr std::size_t panels = 6;  // of a sequence, at most
constexpr const char* speed_words = "Speed of the soil. Front: run-out distance of the farthest particle";

// Draws into DIR/figures and remembers what.
class Album {
 public:
  explicit Album(const fs::path& directory) : directory_(directory / "figures") {
    std::error_code error;
    fs::create_directories(directory_, error);
    if (error) throw IoError("cannot create " + directory_.string() + ": " + error.message());
  }
  void add(const std::string& name, const Sheet& sheet) {
    for (const char* ending : {".svg", ".png"}) sheet.save(drawn_.emplace_back(directory_ / (name + ending)));
  }
  /// What a function draws, given a path without ending.
  template <class Plot>
  void add_plot(const std::string& name, const Plot& plot) {
    std::ranges::move(plot(directory_ / name), std::back_inserter(drawn_));
  }
  void add(const std::string& name, std::span<const Snapshot> snapshots, const Model& model, const Stamps& stamps,
           ProfileOptions options = {}) {
    options.structures = structures_of(model);
    for (const char* ending : {".svg", ".png"}) {
      plot_profiles(snapshots, model.terrain, model.dx, drawn_.emplace_back(directory_ / (name + ending)), stamps,
                    options);
    }
  }
  const std::vector<fs::path>& drawn() const { return drawn_; }

 private:
  fs::path directory_;
  std::vector<fs::path> drawn_;
};

// At most `panels` of n indices, evenly spread, first and last among them.
std::vector<std::size_t> spread_out(std::size_t n) {
  std::set<std::size_t> chosen;
  const std::size_t wanted = std::min(n, panels);
  for (std::size_t k = 0; k < wanted; ++k)
    chosen.insert(wanted == 1 ? 0 : (k * (n - 1) + (wanted - 1) / 2) / (wanted - 1));
  return {chosen.begin(), chosen.end()};
}

std::vector<Frame> some_frames(const fs::path& file) {
  std::vector<Frame> frames;
  for (const std::size_t k : spread_out(snapshot_times(file).size())) frames.push_back(read_frame(file, k));
  if (frames.empty()) throw IoError(file.string() + " contains no snapshot");
  return frames;
}

// The motion coloured by speed, and where weak and strong soil started and ended.
void draw_motion(Album& album, const fs::path& file, const std::string& suffix, const Model& model, Stamps stamps) {
  const std::string whose = stamps.subtitle;
  const std::vector<Frame> frames = some_frames(file);
  std::vector<Snapshot> speed;
  for (const Frame& frame : frames) speed.push_back({&frame, Colour::speed, {}});
  stamps.subtitle = whose + speed_words;
  album.add("speed" + suffix, speed, model, stamps);
  std::vector<Snapshot> friction_angle{{&frames.front(), Colour::friction_angle, {}}};
  if (frames.size() > 1) friction_angle.push_back({&frames.back(), Colour::friction_angle, {}});
  stamps.subtitle = whose + "Friction angle (carried by the particles)";
  album.add("friction_angle" + suffix, friction_angle, model, stamps);
}

LoadedCase resolved_case(const fs::path& directory) {
  try {
    return load_case(directory / "case.resolved.json");
  } catch (const ConfigError& e) {
    throw IoError((directory / "case.resolved.json").string() + " is damaged: " + e.what());
  }
}

std::string run_source(const Provenance& from) {
  std::string line = "Talus " + from.version + "  ·  seed " + std::to_string(from.seed);
  if (from.realization) line += "  ·  realization " + std::to_string(*from.realization);
  return line + "  ·  case " + from.case_hash;
}

// How far the soil came and how it presses, at the end.
void draw_end(Album& album, const fs::path& file, const Model& model, Stamps stamps) {
  const Frame frame = read_frame(file, snapshot_times(file).size() - 1);
  stamps.subtitle = "At the last snapshot";
  album.add("end", std::array{Snapshot{&frame, Colour::displacement, {}}, Snapshot{&frame, Colour::pressure, {}}},
            model, stamps);
}

// Runs of earlier versions have no energy in their history, or no history.
void draw_energy(Album& album, const fs::path& file, const Stamps& stamps) {
  if (!fs::exists(file)) return;
  const std::vector<HistoryRow> history = read_history(file);
  const auto moved = [](const HistoryRow& row) { return row.energy.potential != 0.0; };
  if (std::ranges::any_of(history, moved)) album.add("energy", energy_sheet(history, stamps));
}

// Every snapshot in the same view and colours, one at a time in memory.
void draw_snapshots(Album& album, const fs::path& file, const Model& model, Stamps stamps) {
  stamps.subtitle = speed_words;
  const std::size_t n = snapshot_times(file).size();
  ColourRange range{0.0, 0.0};
  Box view{{1e300, 1e300}, {-1e300, -1e300}};
  for (std::size_t k = 0; k < n; ++k) {
    const Frame frame = read_frame(file, k);
    const std::array<const Frame*, 1> one{&frame};
    const Box box = view_of(one, model.terrain, model.dx);
    view.include(box.lo);
    view.include(box.hi);
    range.hi = std::max(range.hi, value_range(one, Colour::speed).hi);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Frame frame = read_frame(file, k);
    char name[32];
    std::snprintf(name, sizeof name, "snapshot_%03zu", k);
    album.add(name, std::array{Snapshot{&frame, Colour::speed, {}}}, model, stamps, {.range = range, .view = view});
  }
}

}  // namespace

std::vector<fs::path> plot_study(const fs::path& directory) {
  const StudyFiles study = read_study(directory);
  if (study.done == 0) throw IoError(directory.string() + ": no realization is done yet, so there is nothing to draw");
  Album album(directory);
  album.add("histogram", histogram_sheet(study));
  album.add("exceedance", exceedance_sheet(study));
  album.add("running_mean", running_mean_sheet(study));
  album.add("friction_angle_scatter", friction_angle_sheet(study));
  album.add("spread", spread_sheet(study));
  if (!fs::exists(directory / "case.resolved.json")) return album.drawn();
  const LoadedCase loaded = resolved_case(directory);
  const Model& model = loaded.value.model;
  if (find_plan(directory))  // a study of an early version may have none
    album.add_plot("influence",
                   [&](const fs::path& name) { return plot_influence(study, read_tables(directory), loaded, name); });
  album.add("hit_probability",
            hit_probability_sheet(study, model.terrain, model.slide, model.targets, structures_of(model)));
  for (const std::string which : {"first", "worst"}) {
    const fs::path file = directory / "profiles" / (which + ".vtkhdf");
    if (!fs::exists(file)) continue;
    if (is_damaged_profile({directory}, which))
      throw IoError(file.string() + " is damaged; the same talus study command makes it again");
    const std::string name = which == "first" ? "First realization. " : "Realization with the longest run-out. ";
    draw_motion(album, file, "_" + which, model, {study.title, name, study.source, study.quality});
  }
  return album.drawn();
}

std::vector<fs::path> plot_run(const fs::path& directory) {
  const fs::path file = directory / "snapshots.vtkhdf";
  const auto [result, from] = read_result(directory / "result.json");
  const Model model = resolved_case(directory).value.model;
  const Stamps stamps{from.case_title, {}, run_source(from), verdict_lines(result.quality)};
  Album album(directory);
  draw_motion(album, file, "", model, stamps);
  draw_end(album, file, model, stamps);
  draw_energy(album, directory / "history.csv", stamps);
  draw_snapshots(album, file, model, stamps);
  return album.drawn();
}

}  // namespace talus

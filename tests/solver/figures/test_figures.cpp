#include <gtest/gtest.h>

#include <algorithm>

#include "case/load.hpp"
#include "example_study.hpp"
#include "figures/figures.hpp"
#include "io/history.hpp"
#include "io/result_json.hpp"
#include "io/vtkhdf.hpp"
#include "reading.hpp"
#include "statistics/stream.hpp"
#include "study/plan.hpp"
#include "support/error.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

// A block of soil that moves right by `moved`.
Frame block_of_soil(double time, double moved) {
  Frame frame;
  frame.time = time;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) frame.position.push_back({0.5 * i + 0.25 + moved, 0.5 * j + 0.25});
  }
  frame.n_soil = frame.position.size();
  frame.displacement.assign(frame.n_soil, {moved, 0});
  frame.velocity.assign(frame.n_soil, {time, 0});
  frame.density.assign(frame.n_soil, 2000);
  frame.pressure.assign(frame.n_soil, 1000);
  frame.tan_phi.assign(frame.n_soil, 0.4);
  frame.shear_rate.assign(frame.n_soil, 0);
  frame.stress.assign(frame.n_soil, {});
  return frame;
}

void write_case(const fs::path& directory) {
  const auto document = nlohmann::ordered_json::parse(R"({
    "title": "Block", "particle_spacing_m": 0.5,
    "terrain": {"bed_m": [[0, 0], [20, 0]]},
    "slide": {"outlines": [{"outline_m": [[0, 0], [2, 0], [2, 2], [0, 2]]}]},
    "material": {"density_kg_m3": 2000, "friction_angle_deg": 25},
    "time": {"end_s": 3}})");
  write_file_atomically(directory / "case.resolved.json", load_case(document, directory).resolved.dump(2));
}

void write_snapshots(const fs::path& file) {
  SnapshotWriter writer(file, block_of_soil(0, 0));
  writer.append(block_of_soil(1, 3));
  writer.append(block_of_soil(2, 5));
  writer.close();
}

void write_result(const fs::path& directory, const Quality& quality = {}) {
  RunResult result;
  result.quality = quality;
  result.digest = "0123456789abcdef";
  const Provenance from{
      "0.1.0", 42, 3, {}, "0123456789abcdef", "It's a \"block\"; `id`", "g++", "2025-01-31T12:00:00Z"};
  write_file_atomically(directory / "result.json", result_json(result, from).dump(2));
}

void write_moving_history(const fs::path& directory) {
  std::vector<HistoryRow> rows(2);
  rows[1].time = 2;
  rows[1].energy = {.kinetic = 20, .potential = -100, .friction = 90, .boundaries = -12};
  write_history(directory / "history.csv", rows);
}

std::vector<std::string> names(const std::vector<fs::path>& paths) {
  std::vector<std::string> all;
  for (const fs::path& path : paths) all.push_back(path.filename().string());
  return all;
}

TEST(Figures, ARunOfAnEarlierVersionHasNoEnergyToDraw) {
  const test::TemporaryDirectory directory;
  write_case(directory.path());
  write_snapshots(directory / "snapshots.vtkhdf");
  write_result(directory.path());
  const auto draws_energy = [&] { return std::ranges::count(names(plot_run(directory.path())), "energy.svg") > 0; };
  EXPECT_FALSE(draws_energy()) << "no history";
  write_history(directory / "history.csv", std::vector<HistoryRow>(2));
  EXPECT_FALSE(draws_energy()) << "a history without energy";
}

TEST(Figures, ARunIsDrawnFromItsFiles) {
  const test::TemporaryDirectory directory;
  write_case(directory.path());
  write_snapshots(directory / "snapshots.vtkhdf");
  write_result(directory.path());
  write_moving_history(directory.path());
  const std::vector<fs::path> drawn = plot_run(directory.path());
  EXPECT_EQ(names(drawn),
            (std::vector<std::string>{"speed.svg", "speed.png", "friction_angle.svg", "friction_angle.png", "end.svg",
                                      "end.png", "energy.svg", "energy.png", "snapshot_000.svg", "snapshot_000.png",
                                      "snapshot_001.svg", "snapshot_001.png", "snapshot_002.svg", "snapshot_002.png"}));
  for (const fs::path& path : drawn) {
    EXPECT_EQ(path.parent_path(), directory / "figures");
    if (path.extension() == ".png") {
      EXPECT_GT(test::png_size(path).width, 1000u);
    }
  }
  const std::string svg = read_file(directory / "figures/snapshot_001.svg", 1'000'000);
  EXPECT_TRUE(test::contains(svg, "front 4.75 m"));  // farthest centre 0.5*3 + 0.25, moved by 3
  EXPECT_TRUE(test::contains(svg, "realization 3"));
  // All snapshots have one scale.
  EXPECT_EQ(test::png_size(directory / "figures/snapshot_000.png"),
            test::png_size(directory / "figures/snapshot_002.png"));
  // Nothing half-written stays behind.
  EXPECT_EQ(std::distance(fs::directory_iterator(directory / "figures"), fs::directory_iterator{}),
            static_cast<std::ptrdiff_t>(drawn.size()));
}

TEST(Figures, EveryPictureOfARunCarriesItsVerdict) {
  const test::TemporaryDirectory directory;
  write_case(directory.path());
  write_snapshots(directory / "snapshots.vtkhdf");
  write_moving_history(directory.path());
  const auto svgs_with = [&](const std::vector<std::string>& words) {
    std::size_t with = 0, all = 0;
    for (const fs::path& path : plot_run(directory.path())) {
      if (path.extension() != ".svg") continue;
      ++all;
      const std::string svg = read_file(path, 1'000'000);
      const bool has_all = std::ranges::all_of(words, [&](const std::string& w) { return test::contains(svg, w); });
      with += has_all ? 1 : 0;
    }
    EXPECT_EQ(all, 7u);
    return with;
  };
  write_result(directory.path(), {.verdict = Verdict::sound});
  EXPECT_EQ(svgs_with({"doubtful"}), 0u);
  const unsigned without = test::png_size(directory / "figures/end.png").height;
  write_result(directory.path(),
               {.verdict = Verdict::doubtful,
                .reasons = {{.check = "still_moving", .verdict = Verdict::doubtful, .message = "it moves"},
                            {.check = "compression", .verdict = Verdict::doubtful, .message = "it is squeezed"}}});
  EXPECT_EQ(svgs_with({"doubtful: it moves", "doubtful: it is squeezed"}), 7u);
  EXPECT_EQ(test::png_size(directory / "figures/end.png").height, without + 2 * 2 * 18) << "two lines of room";
}

TEST(Figures, AStudyIsDrawnFromItsFiles) {
  const test::TemporaryDirectory directory;
  test::write_example_study(directory.path(), test::example_plan(20), test::example_records(20, true),
                            test::example_floor());
  EXPECT_EQ(plot_study(directory.path()).size(), 2u * 5);  // merged studies have neither case nor profiles
  write_case(directory.path());
  EXPECT_EQ(plot_study(directory.path()).size(), 2u * 6);
  fs::create_directory(directory / "profiles");
  write_snapshots(directory / "profiles/first.vtkhdf");
  write_snapshots(directory / "profiles/worst.vtkhdf");
  const std::vector<fs::path> drawn = plot_study(directory.path());
  EXPECT_EQ(names(drawn), (std::vector<std::string>{"histogram.svg",
                                                    "histogram.png",
                                                    "exceedance.svg",
                                                    "exceedance.png",
                                                    "running_mean.svg",
                                                    "running_mean.png",
                                                    "friction_angle_scatter.svg",
                                                    "friction_angle_scatter.png",
                                                    "spread.svg",
                                                    "spread.png",
                                                    "hit_probability.svg",
                                                    "hit_probability.png",
                                                    "speed_first.svg",
                                                    "speed_first.png",
                                                    "friction_angle_first.svg",
                                                    "friction_angle_first.png",
                                                    "speed_worst.svg",
                                                    "speed_worst.png",
                                                    "friction_angle_worst.svg",
                                                    "friction_angle_worst.png"}));
  for (const fs::path& path : drawn) EXPECT_TRUE(fs::exists(path)) << path;
}

/// A study of a slide with a random field, whose front follows its first coefficient.
Plan write_study_of_a_field(const fs::path& directory) {
  const auto document = nlohmann::ordered_json::parse(R"({
    "title": "Block", "particle_spacing_m": 0.5,
    "terrain": {"bed_m": [[0, 0], [20, 0]]},
    "slide": {"outlines": [{"outline_m": [[0, 0], [4, 0], [4, 3], [0, 3]]}]},
    "material": {"density_kg_m3": 2000, "friction_angle_deg": 25},
    "time": {"end_s": 3},
    "random_field": {"correlation_length_m": 4, "log_stdev": 0.2, "terms": 8},
    "study": {"realizations": 40, "seed": 42}})");
  const LoadedCase loaded = load_case(document, directory);
  write_file_atomically(directory / "case.resolved.json", loaded.resolved.dump(2));
  const Plan plan = make_plan(loaded, 42, "0.1.0");
  write_plan(directory, plan);  // as an earlier version did: without the draws
  std::vector<Record> records = test::example_records(40, true);
  for (Record& r : records)
    r.measures.front_mass_99 =
        30 - standard_normal(42, static_cast<std::uint64_t>(r.index), 0) + 1e-3 * r.measures.influence_zone;
  test::write_example_study(directory, plan, records, {});
  return plan;
}

TEST(Figures, SoilThatMovesTheFrontIsDrawnWhereThereIsARegression) {
  const test::TemporaryDirectory directory;
  Plan plan = write_study_of_a_field(directory.path());
  const auto has_influence = [&] {
    const std::vector<std::string> drawn = names(plot_study(directory.path()));
    return std::ranges::count(drawn, "influence.svg") + std::ranges::count(drawn, "influence.png");
  };
  EXPECT_EQ(has_influence(), 2);
  const std::string svg = read_file(directory / "figures/influence.svg", 10'000'000);
  EXPECT_NE(svg.find("friction: 100 % [100, 100] of the variance"), std::string::npos);
  plan.study.sampling = Sampling::latin_hypercube;
  write_plan(directory.path(), plan);
  EXPECT_EQ(has_influence(), 0);
}

// The picture follows the data: one more realization in a bin is another picture.
TEST(Figures, AMutatedCountIsSeen) {
  const test::TemporaryDirectory directory;
  test::write_example_study(directory.path(), test::example_plan(20), test::example_records(20, false),
                            test::example_floor());
  plot_study(directory.path());
  const std::string before = read_file(directory / "figures/histogram.svg", 1'000'000);
  plot_study(directory.path());
  EXPECT_EQ(read_file(directory / "figures/histogram.svg", 1'000'000), before);
  auto study = nlohmann::ordered_json::parse(read_file(directory / "study.json", 1'000'000));
  auto& count = study["quantities"]["influence_zone_m"]["histogram"]["counts"][0];
  count = count.get<int>() + 1;
  write_file_atomically(directory / "study.json", study.dump());
  plot_study(directory.path());
  EXPECT_NE(read_file(directory / "figures/histogram.svg", 1'000'000), before);
}

TEST(Figures, NothingDoneNothingDrawn) {
  const test::TemporaryDirectory directory;
  test::write_example_study(directory.path(), test::example_plan(1), test::example_records(1, true), {});
  EXPECT_THROW(plot_study(directory.path()), IoError);
  EXPECT_FALSE(fs::exists(directory / "figures"));
  EXPECT_THROW(plot_run(directory.path()), IoError);
}

}  // namespace
}  // namespace talus

// Runs of the same realizations at two particle spacings: what differs is the resolution, not the soil.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "run/run_realization.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

constexpr int pairs = 12;

LoadedCase slide_with_circulant_field(const std::string& spacing) {
  const Json document = {{"title", "slope"},
                         {"particle_spacing_m", 0.4},
                         {"terrain", {{"bed_m", {{0, 4}, {8, 0}, {60, 0}}}}},
                         {"slide", {{"outlines", {{{"outline_m", {{0, 4}, {8, 0}, {10, 0}, {4, 7}, {0, 7}}}}}}}},
                         {"material", {{"density_kg_m3", 2000}, {"friction_angle_deg", 25}}},
                         {"numerics", {{"integrator", "leapfrog"}}},
                         {"time", {{"end_s", 4}}},
                         {"random_field",
                          {{"correlation_length_m", 2},
                           {"cov_tan_phi", 0.3},
                           {"sampler", "circulant_embedding"},
                           {"cell_average", true}}}};
  const std::vector<std::string> changes{"particle_spacing_m=" + spacing};
  return load_case(document, "", changes);
}

/// Front of 99 % of the mass, of each realization [m].
std::vector<double> fronts(const std::string& spacing, const std::filesystem::path& directory) {
  const RunHooks silent{.stop_requested = [] { return false; }, .show_progress = [](const Simulation&, double) {}};
  std::vector<double> all;
  for (int k = 0; k < pairs; ++k) {
    RunRequest request;
    request.directory = directory / (spacing + "-" + std::to_string(k));
    request.seed = 5;
    request.realization = k;
    request.version = "test";
    all.push_back(run_realization(slide_with_circulant_field(spacing), request, silent).result.measures.front_mass_99);
  }
  return all;
}

double correlation_of(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < pairs; ++k) {
    mx += x[k] / pairs;
    my += y[k] / pairs;
  }
  for (std::size_t k = 0; k < pairs; ++k) {
    xx += (x[k] - mx) * (x[k] - mx);
    yy += (y[k] - my) * (y[k] - my);
    xy += (x[k] - mx) * (y[k] - my);
  }
  return xy / std::sqrt(xx * yy);
}

// 0.98 over 24 pairs. Two unrelated fields would reach 0.9 with a probability of 3e-5 (12 pairs, t = 6.5).
TEST(TwoSpacings, RunsOfOneCirculantFieldAreCorrelated) {
  const test::TemporaryDirectory directory;
  EXPECT_GT(correlation_of(fronts("0.4", directory.path()), fronts("0.2", directory.path())), 0.9);
}

}  // namespace
}  // namespace talus

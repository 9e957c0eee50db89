// The same bits as an earlier program: short runs of every choice of the method (recorded_digests.json, made by
// record_digests.py).

#include <gtest/gtest.h>
#include <omp.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "case/load.hpp"
#include "run/realization.hpp"
#include "simulation/simulation.hpp"
#include "sph/pair_loops.hpp"

namespace talus {
namespace {

using nlohmann::ordered_json;

const std::string source = TALUS_SOURCE_DIR;

ordered_json read_json(const std::string& path) {
  std::ifstream file(path);
  return ordered_json::parse(file);
}

const std::string whole_cells = R"(particle_placement="whole_cells")";

/// Vectors without fused multiply-adds round differently.
bool has_fused_multiply_add() { return std::string(pair_loops_target()).find("AVX") == 0; }

Simulation simulation_of(const Case& c, const RunIdentity& identity) {
  const ParticlePlan plan = plan_particles(c.model);
  return {c.model, plan, strength(c.model, c.field, c.study, plan, identity).properties};
}

void finish(Simulation& simulation, const Case& c) {
  while (!simulation.finished()) simulation.step(c.model.time.end);
}

/// The recorded runs.
struct RecordedDigests : testing::Test {
  void SetUp() override {
    if (!has_fused_multiply_add()) GTEST_SKIP() << "the digests are those of AVX2 and better";
    omp_set_num_threads(1);
  }

  const ordered_json table = read_json(source + "/tests/solver/simulation/recorded_digests.json");

  Case case_of(const ordered_json& run) const {
    std::vector<std::string> overrides;
    for (const auto& [key, value] : run["set"].items()) overrides.push_back(key + "=" + value.dump());
    return load_case(table["case"], {}, overrides).value;
  }
  static Simulation simulation_of(const Case& c) {
    return talus::simulation_of(c, {c.study.seed.value_or(0), std::nullopt, 0.0});
  }
  static void expect_as_recorded(const Simulation& simulation, const ordered_json& run) {
    const RunResult result = simulation.result();
    EXPECT_EQ(result.digest, run["digest"].get<std::string>()) << run["set"];
    EXPECT_EQ(result.steps, run["steps"].get<std::int64_t>()) << run["set"];
    EXPECT_EQ(result.left_domain, run["left"].get<std::int64_t>()) << run["set"];
  }
};

TEST_F(RecordedDigests, EveryChoiceOfTheMethod) {
  ASSERT_GT(table["runs"].size(), 190u);
  for (const auto& run : table["runs"]) {
    const Case c = case_of(run);
    Simulation simulation = simulation_of(c);
    finish(simulation, c);
    expect_as_recorded(simulation, run);
  }
}

TEST_F(RecordedDigests, TwoAndThreeThreads) {
  for (std::size_t k = 0; k < table["runs"].size(); k += 11) {
    const auto& run = table["runs"][k];
    const Case c = case_of(run);
    omp_set_num_threads(k % 2 == 0 ? 2 : 3);
    Simulation simulation = simulation_of(c);
    finish(simulation, c);
    expect_as_recorded(simulation, run);
  }
}

TEST_F(RecordedDigests, RunsThatWereInterruptedAndResumed) {
  for (std::size_t k = 0; k < table["runs"].size(); k += 7) {
    const auto& run = table["runs"][k];
    const Case c = case_of(run);
    Simulation first = simulation_of(c);
    for (std::int64_t step = 0; 2 * step < run["steps"].get<std::int64_t>(); ++step) first.step(c.model.time.end);
    Simulation second = simulation_of(c);
    second.restore(first.state());
    finish(second, c);
    expect_as_recorded(second, run);
  }
}

}  // namespace
}  // namespace talus

// The loops of one evaluation, each by itself, over 12,800 and a million particles of disordered soil. Items are soil
// particles.

#include <benchmark/benchmark.h>

#include <cstdint>

#include "random_soil.hpp"
#include "sph/pair_loops.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// Everything that the loops need, laid out as VectorisedFlow does it.
struct Bed {
  static constexpr double way_h = 0.05;  ///< what a particle may move before the lists are renewed [h]

  /// @param width  particles along x; half as many along y
  explicit Bed(std::int64_t width = 160, KernelShape kernel = KernelShape::cubic_spline) {
    k.numerics.precision = Precision::single;
    k.numerics.kernel = kernel;
    soil = random_soil(static_cast<int>(width), static_cast<int>(width / 2), k.dx, 3);
    for (auto* t : {&soil.txx, &soil.tyy, &soil.txy})
      for (double& value : *t) value *= 0.1;  // some yield, some do not
    walls = flat_walls(static_cast<int>(width), k.dx);
    soil_cells = sorted(soil, 2.3 * k.h);
    wall_cells = sorted(walls, 2.0 * k.h);
    f.fixed = FixedPoint::covering(soil_cells.box(), k.h);
    f.soil.resize(soil.size());
    f.walls.resize(walls.size());
    f.soil_clusters = clusters(soil_cells, cluster_size());
    f.wall_clusters = clusters(wall_cells, cluster_size());
    f.soil_soil.resize(f.soil_clusters);
    f.soil_wall.resize(f.soil_clusters);
    f.wall_soil.resize(f.wall_clusters);
    pack_walls(f, k, walls);
    pack_soil(f, k, soil, 0.0, {0, soil.size()});
    list();
  }
  void list() {
    const double reach = 2.0 * k.h + way_h * k.h;
    const auto n_soil = static_cast<std::uint32_t>(soil.size()), n_wall = static_cast<std::uint32_t>(walls.size());
    const std::vector<float>&at_soil = f.soil.motion, &at_walls = f.walls.place;
    const double wider = reach + way_h * k.h, moved = 0.3 * k.h;
    const NeighbourSearch soil_soil{f.fixed, f.soil_clusters, at_soil, at_soil, soil_cells, wider, moved, n_soil};
    const NeighbourSearch soil_wall{f.fixed, f.soil_clusters, at_soil, at_walls, wall_cells, reach, 0.0, n_wall};
    const NeighbourSearch wall_soil{f.fixed, f.wall_clusters, at_walls, at_soil, soil_cells, reach, moved, n_soil};
    for (std::size_t b = 0; b < f.soil_soil.batches.size(); ++b) {
      list_neighbours(soil_soil, b, f.soil_soil);
      list_neighbours(soil_wall, b, f.soil_wall);
    }
    for (std::size_t b = 0; b < f.wall_soil.batches.size(); ++b) list_neighbours(wall_soil, b, f.wall_soil);
  }
  void stress() { stress_pass(f, k, soil, 0.0, false, false, {0, f.soil_clusters.size() - 1}); }
  void report(benchmark::State& state) const {
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * soil.size()));
    state.SetLabel(pair_loops_target());
  }

  FlowConstants k = constants(0.1);
  Soil soil;
  WallParticles walls;
  CellList soil_cells, wall_cells;
  PackedFlow f;
};

void Pack(benchmark::State& state) {
  Bed bed(state.range(0));
  for (auto _ : state) pack_soil(bed.f, bed.k, bed.soil, 1e-5, {0, bed.soil.size()});
  bed.report(state);
}
void Sort(benchmark::State& state) {
  Bed bed(state.range(0));
  std::vector<double> scratch;
  for (auto _ : state) {
    bed.soil_cells.build(bed.soil.x, bed.soil.y, 2.3 * bed.k.h);
    for_each_state(bed.soil, [&](const char*, auto& array) { permute(array, bed.soil_cells.order(), scratch); });
  }
  bed.report(state);
}
void Lists(benchmark::State& state) {
  Bed bed(state.range(0));
  for (auto _ : state) bed.list();
  bed.report(state);
}
void StressPass(benchmark::State& state) {
  Bed bed(state.range(0), static_cast<KernelShape>(state.range(1)));
  for (auto _ : state) bed.stress();
  bed.report(state);
}
void WallStressPass(benchmark::State& state) {
  Bed bed;
  bed.stress();
  for (auto _ : state)
    for (std::size_t c = 0; c < bed.f.wall_soil.batches.size(); ++c) wall_stress_pass(bed.f, bed.k, bed.walls, c);
  bed.report(state);
}
void MomentumPass(benchmark::State& state) {
  Bed bed(state.range(0), static_cast<KernelShape>(state.range(1)));
  bed.stress();
  for (auto _ : state) momentum_pass(bed.f, bed.k, false, {0, bed.f.soil_clusters.size() - 1});
  bed.report(state);
}
void Move(benchmark::State& state) {
  Bed bed(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(move_soil(bed.f, bed.k, bed.soil, 0.0, true, {0, bed.soil.size()}));
  bed.report(state);
}
void PlainEvaluation(benchmark::State& state) {
  Bed bed;
  for (auto _ : state) evaluate_plain(bed.k, bed.soil, bed.walls, {bed.soil_cells, bed.wall_cells});
  bed.report(state);
}

constexpr std::int64_t narrow = 160, wide = 1414;  // 12,800 and 999,698 particles

BENCHMARK(Sort)->ArgName("width")->Arg(narrow)->Arg(wide);
BENCHMARK(Lists)->ArgName("width")->Arg(narrow)->Arg(wide);
BENCHMARK(Pack)->ArgName("width")->Arg(narrow)->Arg(wide);
BENCHMARK(StressPass)->ArgNames({"width", "wendland"})->ArgsProduct({{narrow, wide}, {0, 1}});
BENCHMARK(WallStressPass);
BENCHMARK(MomentumPass)->ArgNames({"width", "wendland"})->ArgsProduct({{narrow, wide}, {0, 1}});
BENCHMARK(Move)->ArgName("width")->Arg(narrow)->Arg(wide);
BENCHMARK(PlainEvaluation);

}  // namespace
}  // namespace talus

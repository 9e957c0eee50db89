// Evaluating a random field at the particles of a slope: 12,800 points, on their lattice and scattered.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>

#include "random_field/random_field.hpp"

namespace talus {
namespace {

std::vector<Vec2> points(bool lattice) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> x(0.0, 16.0), y(0.0, 8.0);
  std::vector<Vec2> all;
  for (int i = 0; i < 160; ++i)
    for (int j = 0; j < 80; ++j)
      all.push_back(lattice ? Vec2{0.1 * i + 0.05, 0.1 * j + 0.05} : Vec2{x(engine), y(engine)});
  return all;
}

void Evaluate(benchmark::State& state) {
  const RandomField field({.ell_x = 0.5, .ell_y = 0.5, .sigma = 0.2, .terms = static_cast<int>(state.range(0))},
                          {{0, 0}, {16, 8}}, 0.1);
  const std::vector<Vec2> at = points(state.range(1) == 1);
  const std::vector<double> xi = field.draw(1, 1);
  for (auto _ : state) benchmark::DoNotOptimize(field.gaussian(at, xi));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * at.size()));
}
void SolveModes(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(
        RandomField({.ell_x = 0.5, .ell_y = 0.5, .sigma = 0.2, .terms = static_cast<int>(state.range(0))},
                    {{0, 0}, {16, 8}}, 0.1)
            .terms());
}
void Embed(benchmark::State& state) {
  const RandomField field({.ell_x = 0.5, .ell_y = 0.5, .sigma = 0.2, .sampler = FieldSampler::circulant_embedding},
                          {{0, 0}, {16, 8}}, 0.1);
  const std::vector<Vec2> at = points(true);
  const std::vector<double> xi = field.draw(1, 1);
  for (auto _ : state) benchmark::DoNotOptimize(field.gaussian(at, xi));
}

BENCHMARK(Evaluate)
    ->ArgNames({"terms", "lattice"})
    ->Args({5, 1})
    ->Args({10000, 1})
    ->Args({10000, 0})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(SolveModes)->Arg(5)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(Embed)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace talus

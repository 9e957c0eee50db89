#include "integrate/vectorised_flow.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>

namespace talus {

namespace {

/// Calls f(array of Soil, array of packed floats, stride, offset) for all that evaluations write.
template <class S, class P, class F>
void for_each_pair(S& soil, P& packed, F&& f) {
  f(soil.ax, packed.ax, 1, 0);
  f(soil.ay, packed.ay, 1, 0);
  f(soil.drho, packed.drho, 1, 0);
  f(soil.dtxx, packed.dtxx, 1, 0);
  f(soil.dtyy, packed.dtyy, 1, 0);
  f(soil.dtxy, packed.dtxy, 1, 0);
  f(soil.gamma_dot, packed.gamma_dot, 1, 0);
  f(soil.sxx, packed.stress, 4, 0);
  f(soil.syy, packed.stress, 4, 1);
  f(soil.sxy, packed.stress, 4, 2);
  f(soil.p, packed.stress, 4, 3);
}

/// The place of each wall particle's boundary among those whose load is asked for, else -1.
void mark_loaded(std::vector<std::int32_t>& slot, const WallParticles& walls, std::span<const LoadedBoundary> loaded) {
  std::ranges::fill(slot, -1);
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (std::size_t s = 0; s < loaded.size(); ++s)
      if (walls.boundary[w] == loaded[s].boundary) slot[w] = static_cast<std::int32_t>(s);
}

/// The value that all have in common, if there is one: it need not be loaded for every particle.
std::optional<double> common_value(std::span<const double> values) {
  const bool same = std::ranges::adjacent_find(values, std::not_equal_to()) == values.end();
  return same && !values.empty() ? std::optional(values.front()) : std::nullopt;
}

}  // namespace

VectorisedFlow::VectorisedFlow(FlowConstants constants, const Soil& soil) : Flow(std::move(constants)) {
  flow_.soil.resize(soil.size());
  flow_.powers.resize(soil.size());
  for (std::size_t i = 0; i < soil.size(); ++i) {
    float* stress = flow_.soil.stress.data() + 4 * i;
    stress[3] = static_cast<float>(initial_pressure(this->constants(), soil, i));
    stress[0] = stress[1] = -stress[3];
  }
}

void VectorisedFlow::read_evaluation(const Soil&, Soil& to) const {
  const std::size_t n = flow_.soil.size();
  for_each_pair(to, flow_.soil, [&](auto& array, const auto& packed, std::size_t stride, std::size_t offset) {
    array.resize(n);
    for (std::size_t i = 0; i < n; ++i) array[i] = static_cast<double>(packed[stride * i + offset]);
  });
}

void VectorisedFlow::write_evaluation(Soil&, const Soil& from) {
  for_each_pair(from, flow_.soil, [&](const auto& array, auto& packed, std::size_t stride, std::size_t offset) {
    for (std::size_t i = 0; i < array.size(); ++i) packed[stride * i + offset] = static_cast<float>(array[i]);
  });
}

ElasticRates VectorisedFlow::elastic_rates(const Soil&, std::size_t i) const {
  const PackedSoil& s = flow_.soil;
  const auto wide = [i](const std::vector<float>& array) { return static_cast<double>(array[i]); };
  return {wide(s.drho), wide(s.dtxx), wide(s.dtyy), wide(s.dtxy)};
}

void VectorisedFlow::swap_rates(Soil& soil, std::size_t i, std::size_t j) {
  for_each_pair(soil, flow_.soil, [&](auto&, auto& packed, std::size_t stride, std::size_t offset) {
    std::swap(packed[stride * i + offset], packed[stride * j + offset]);
  });
}

void VectorisedFlow::permute_rates(Soil& soil, std::span<const std::uint32_t> order, std::vector<double>& scratch) {
  for_each_pair(soil, flow_.soil, [&](auto&, auto& packed, std::size_t stride, std::size_t) {
    if (stride == 1) permute(packed, order, scratch);  // the stress is rewritten before it is read
  });
}

void VectorisedFlow::rebuild_neighbour_lists(const Soil& soil, const WallParticles& walls, const ParticleCells& cells,
                                             double moved_since_sort, double skin) {
  const std::size_t lanes = cluster_size();
  const double reach = 2.0 * constants().h + skin;
  flow_.mass = common_value(soil.m);
  flow_.fixed = FixedPoint::covering(cells.soil.box(), constants().h);
  flow_.soil_clusters = clusters(cells.soil, lanes);
  flow_.wall_clusters = clusters(cells.walls, lanes);
  flow_.walls.resize(walls.size());
  flow_.soil_soil.resize(flow_.soil_clusters);
  flow_.soil_wall.resize(flow_.soil_clusters);
  flow_.wall_soil.resize(flow_.wall_clusters);
  pack_walls(flow_, constants(), walls);
  mark_loaded(flow_.walls.slot, walls, loaded_);
  pack_strength(flow_, soil);
  work_.resize(flow_.soil_soil.batches.size() + 1);
  std::iota(work_.begin(), work_.end(), std::size_t{0});  // the lists that tell the work do not exist yet
  partition_work();
  present_is_packed_ = true;
  const auto n_soil = static_cast<std::uint32_t>(soil.size());
  const auto n_wall = static_cast<std::uint32_t>(walls.size());
  const std::vector<float>&at_soil = flow_.soil.motion, &at_walls = flow_.walls.place;
  const FixedPoint& fixed = flow_.fixed;
  // Sources may have moved since the cells were built; from now on targets and sources both may move by `skin`.
  const NeighbourSearch soil_soil{fixed,      flow_.soil_clusters, at_soil,          at_soil,
                                  cells.soil, reach + skin,        moved_since_sort, n_soil};
  const NeighbourSearch soil_wall{fixed, flow_.soil_clusters, at_soil, at_walls, cells.walls, reach, 0.0, n_wall};
  const NeighbourSearch wall_soil{fixed, flow_.wall_clusters, at_walls, at_soil, cells.soil,
                                  reach, moved_since_sort,    n_soil};
#pragma omp parallel
  {
    pack_active(soil, 0.0);
#pragma omp for schedule(static) nowait
    for (std::size_t b = 0; b < flow_.soil_soil.batches.size(); ++b) {
      list_neighbours(soil_soil, b, flow_.soil_soil);
      list_neighbours(soil_wall, b, flow_.soil_wall);
    }
#pragma omp for schedule(dynamic)
    for (std::size_t b = 0; b < flow_.wall_soil.batches.size(); ++b) list_neighbours(wall_soil, b, flow_.wall_soil);
  }
  work_.assign(1, 0);
  for (std::size_t b = 0; b < flow_.soil_soil.batches.size(); ++b) {
    constexpr std::size_t other_work = 10;  // what a cluster costs besides its pairs, in neighbours
    const auto length = [&](const ClusterList& list) { return std::size_t{list.batches[b].at.back()}; };
    work_.push_back(work_.back() + length(flow_.soil_soil) + 2 * length(flow_.soil_wall) +
                    other_work * ClusterList::batch_size);
  }
}

/// Gives each thread consecutive clusters of the soil with as many neighbours as those of the others.
void VectorisedFlow::partition_work() {
  const auto threads = static_cast<std::size_t>(omp_get_max_threads());
  const std::size_t clusters = flow_.soil_clusters.size() - 1;
  const auto border = [&](std::size_t t) {
    const auto work = work_.back() * t / threads;
    const auto batch = static_cast<std::size_t>(std::upper_bound(work_.begin(), work_.end(), work) - work_.begin()) - 1;
    if (batch + 1 == work_.size()) return clusters;
    const std::size_t within = ClusterList::batch_size * (work - work_[batch]) / (work_[batch + 1] - work_[batch]);
    return std::min(ClusterList::batch_size * batch + within, clusters);
  };
  ranges_.resize(threads);
  for (std::size_t t = 0; t < threads; ++t)
    ranges_[t] = {.begin = border(t), .end = border(t + 1), .stress = border(t), .momentum = border(t)};
}

/// Calls f(clusters) for those of the calling thread's range, then for what the other threads have left of theirs: a
/// thread that the machine holds up does not hold up the rest. Many clusters at a time, few towards the end, so that
/// all threads end together. Inside a parallel region.
/// Resets the range of the other pass; callers must place a barrier between the two passes.
template <class F>
void VectorisedFlow::for_clusters_with_stealing(std::size_t ThreadRange::*next, std::size_t ThreadRange::*other,
                                                F&& f) {
  const auto thread = static_cast<std::size_t>(omp_get_thread_num());
  const auto threads = static_cast<std::size_t>(omp_get_num_threads());
  // There may be fewer threads than ranges: OpenMP gives as many as it can.
  for (std::size_t t = thread; t < ranges_.size(); t += threads) ranges_[t].*other = ranges_[t].begin;
  constexpr std::size_t many = 32, few = 8;
  for (std::size_t t = 0; t < ranges_.size(); ++t) {
    ThreadRange& range = ranges_[(thread + t) % ranges_.size()];
    const std::atomic_ref<std::size_t> taken(range.*next);
    for (std::size_t c; (c = taken.load(std::memory_order_relaxed)) < range.end;) {
      const std::size_t some = range.end - c > 4 * many ? many : few;
      c = taken.fetch_add(some, std::memory_order_relaxed);
      if (c < range.end) f(Range{c, std::min(c + some, range.end)});
    }
  }
}

/// Calls f(particles) for those of the calling thread's range, which are in its caches: loops that move memory rather
/// than compute would lose by stealing. Inside a parallel region, which must wait for the other threads afterwards.
template <class F>
void VectorisedFlow::for_local_particles(std::size_t active, F&& f) {
  const auto thread = static_cast<std::size_t>(omp_get_thread_num());
  const auto threads = static_cast<std::size_t>(omp_get_num_threads());
  const auto first = [&](std::size_t cluster) { return std::min<std::size_t>(flow_.soil_clusters[cluster], active); };
  for (std::size_t t = thread; t < ranges_.size(); t += threads)
    f(Range{first(ranges_[t].begin), first(ranges_[t].end)});
}

/// Inside a parallel region.
void VectorisedFlow::pack_active(const Soil& soil, double ahead) {
  for_local_particles(soil.n_active, [&](Range range) { pack_soil(flow_, constants(), soil, ahead, range); });
#pragma omp barrier
}

/// Inside a parallel region.
void VectorisedFlow::evaluate_in_region(Soil& soil, WallParticles& walls, double ahead, bool commit, bool pack,
                                        bool measure, Stopwatch& watch) {
  if (pack) pack_active(soil, ahead);
#pragma omp master
  watch.lap(times_.update);
  for_clusters_with_stealing(&ThreadRange::stress, &ThreadRange::momentum, [&](Range range) {
    stress_pass(flow_, constants(), soil, ahead, commit, measure, range);
  });
#pragma omp barrier
#pragma omp master
  watch.lap(times_.gradient);
#pragma omp for schedule(static)
  for (std::size_t b = 0; b < flow_.wall_soil.batches.size(); ++b) wall_stress_pass(flow_, constants(), walls, b);
#pragma omp master
  watch.lap(times_.walls);
  for_clusters_with_stealing(&ThreadRange::momentum, &ThreadRange::stress,
                             [&](Range range) { momentum_pass(flow_, constants(), measure, range); });
#pragma omp barrier
#pragma omp master
  watch.lap(times_.momentum);
}

void VectorisedFlow::evaluate(Soil& soil, WallParticles& walls, double ahead, bool commit) {
  Stopwatch watch;
  partition_work();
  const bool pack = ahead != 0.0 || !present_is_packed_;
  present_is_packed_ = ahead == 0.0;
#pragma omp parallel
  evaluate_in_region(soil, walls, ahead, commit, pack, false, watch);
}

/// Inside a parallel region; at the state of the last evaluation.
void VectorisedFlow::sum_loads_in_region() {
  const std::size_t clusters = flow_.soil_clusters.size() - 1;
#pragma omp single
  load_of_cluster_.resize(clusters * loaded_.size());
  constexpr std::size_t some = 64;
#pragma omp for schedule(dynamic)
  for (std::size_t c = 0; c < clusters; c += some)
    for (std::size_t s = 0; s < loaded_.size(); ++s)
      load_pass(flow_, constants(), static_cast<std::int32_t>(s), loaded_[s].about,
                Range{c, std::min(c + some, clusters)}, load_of_cluster_.data() + s * clusters);
#pragma omp single
  for (std::size_t s = 0; s < loaded_.size(); ++s) {
    loads_[s] = {};
    for (std::size_t c = 0; c < clusters; ++c) loads_[s] += load_of_cluster_[s * clusters + c];
  }
}

/// What one thread does of a step: the back end of the schemes, inside a parallel region.
struct VectorisedFlow::ThreadStep {
  VectorisedFlow& flow;
  Soil& soil;
  WallParticles& walls;
  Stopwatch& watch;
  bool measure;  ///< the powers in the middle of the step

  void evaluate(double ahead, bool commit) {
    flow.evaluate_in_region(soil, walls, ahead, commit, ahead != 0.0 || !flow.present_is_packed_,
                            measure && ahead != 0.0, watch);
    if (ahead != 0.0 && !flow.loaded_.empty()) flow.sum_loads_in_region();
  }
  StepExtrema move(double dt, PositionVelocity velocity) {
    StepExtrema extrema;
    flow.for_local_particles(soil.n_active, [&](Range range) {
      extrema = extrema.merge(
          move_soil(flow.flow_, flow.constants(), soil, dt, velocity == PositionVelocity::midpoint, range));
    });
    return extrema;
  }
};

StepExtrema VectorisedFlow::step(Soil& soil, WallParticles& walls, const ParticleCells&, double dt, Powers* powers) {
  Stopwatch watch;
  partition_work();
  StepExtrema extrema;
#pragma omp declare reduction(merge:StepExtrema : omp_out = omp_out.merge(omp_in))
#pragma omp parallel reduction(merge : extrema)
  {
    ThreadStep thread{*this, soil, walls, watch, powers != nullptr};
    extrema = advance(constants().numerics.integrator, thread, dt);
  }
  if (powers) *powers = flow_.powers.total(soil.n_active);
  watch.lap(times_.update);
  present_is_packed_ = true;
  return extrema;
}

}  // namespace talus

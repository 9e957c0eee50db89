#include "sph/vectorised_flow.hpp"

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
  f(soil.ax, packed.ax, 1, 0), f(soil.ay, packed.ay, 1, 0), f(soil.drho, packed.drho, 1, 0);
  f(soil.dtxx, packed.dtxx, 1, 0), f(soil.dtyy, packed.dtyy, 1, 0), f(soil.dtxy, packed.dtxy, 1, 0);
  f(soil.gamma_dot, packed.gamma_dot, 1, 0);
  f(soil.sxx, packed.stress, 4, 0), f(soil.syy, packed.stress, 4, 1), f(soil.sxy, packed.stress, 4, 2),
      f(soil.p, packed.stress, 4, 3);
}

/// The one value of all, if they have one: reading it from memory once is faster.
std::optional<double> common(std::span<const double> values) {
  const bool same = std::ranges::adjacent_find(values, std::not_equal_to()) == values.end();
  return same && !values.empty() ? std::optional(values.front()) : std::nullopt;
}

}  // namespace

VectorisedFlow::VectorisedFlow(FlowConstants constants, const Soil& soil) : k_(std::move(constants)) {
  flow_.soil.resize(soil.size());
  for (std::size_t i = 0; i < soil.size(); ++i) {
    const double p = k_.laws[static_cast<std::size_t>(soil.material[i])].eos.pressure(soil.rho[i]);
    float* stress = flow_.soil.stress.data() + 4 * i;
    stress[3] = static_cast<float>(k_.numerics.tension_cutoff ? without_tension(p) : p);
    stress[0] = stress[1] = -stress[3];
  }
}

void VectorisedFlow::unpack(Soil& soil) const {
  const std::size_t n = flow_.soil.size();
  for_each_pair(soil, flow_.soil, [&](auto& array, const auto& packed, std::size_t stride, std::size_t offset) {
    array.resize(n);
    for (std::size_t i = 0; i < n; ++i) array[i] = static_cast<double>(packed[stride * i + offset]);
  });
}

void VectorisedFlow::pack(const Soil& soil) {
  for_each_pair(soil, flow_.soil, [&](const auto& array, auto& packed, std::size_t stride, std::size_t offset) {
    for (std::size_t i = 0; i < array.size(); ++i) packed[stride * i + offset] = static_cast<float>(array[i]);
  });
}

void VectorisedFlow::swap(std::size_t i, std::size_t j) {
  Soil none;
  for_each_pair(none, flow_.soil, [&](auto&, auto& packed, std::size_t stride, std::size_t offset) {
    std::swap(packed[stride * i + offset], packed[stride * j + offset]);
  });
}

void VectorisedFlow::permute(std::span<const std::uint32_t> order, std::vector<double>& scratch) {
  for_each_packed_rate(flow_.soil, [&](const char*, auto& array) { talus::permute(array, order, scratch); });
}

void VectorisedFlow::renew(const Soil& soil, const WallParticles& walls, const CellList& soil_cells,
                           const CellList& wall_cells, double moved, double way) {
  const std::size_t lanes = cluster_size();
  const double reach = 2.0 * k_.h + way;
  const auto lists = [](const std::vector<std::uint32_t>& first) {
    return (first.size() + ClusterList::chunk_size - 2) / ClusterList::chunk_size;
  };
  flow_.mass = common(soil.m);
  flow_.fixed = FixedPoint::covering(soil_cells.box(), k_.h);
  flow_.soil_clusters = clusters(soil_cells, lanes), flow_.wall_clusters = clusters(wall_cells, lanes);
  flow_.walls.resize(walls.size());
  flow_.soil_soil.chunks.resize(lists(flow_.soil_clusters)), flow_.soil_wall.chunks.resize(lists(flow_.soil_clusters));
  flow_.wall_soil.chunks.resize(lists(flow_.wall_clusters));
  pack_walls(flow_, walls);
  work_.resize(flow_.soil_soil.chunks.size() + 1);
  std::iota(work_.begin(), work_.end(), std::size_t{0});  // not known before the lists are
  share_out();
  packed_now_ = true;
  const auto n_soil = static_cast<std::uint32_t>(soil.size()), n_wall = static_cast<std::uint32_t>(walls.size());
  const PackedSoil& s = flow_.soil;
  const PackedWalls& w = flow_.walls;
#pragma omp parallel
  {
    pack_active(soil, 0.0);
    // Sources may have moved since the cells were built; from now on targets and sources both may move by `way`.
#pragma omp for schedule(static) nowait
    for (std::size_t c = 0; c < flow_.soil_soil.chunks.size(); ++c) {
      list_neighbours(flow_.fixed, flow_.soil_clusters, s.motion, soil_cells, s.motion, reach + way, moved, n_soil, c,
                      flow_.soil_soil);
      list_neighbours(flow_.fixed, flow_.soil_clusters, s.motion, wall_cells, w.place, reach, 0.0, n_wall, c,
                      flow_.soil_wall);
    }
#pragma omp for schedule(dynamic)
    for (std::size_t c = 0; c < flow_.wall_soil.chunks.size(); ++c)
      list_neighbours(flow_.fixed, flow_.wall_clusters, w.place, soil_cells, s.motion, reach, moved, n_soil, c,
                      flow_.wall_soil);
  }
  work_.assign(1, 0);
  for (std::size_t c = 0; c < flow_.soil_soil.chunks.size(); ++c) {
    constexpr std::size_t law = 10;  // what a cluster costs besides, in neighbours
    const auto length = [&](const ClusterList& list) { return std::size_t{list.chunks[c].at.back()}; };
    work_.push_back(work_.back() + length(flow_.soil_soil) + 2 * length(flow_.soil_wall) +
                    law * ClusterList::chunk_size);
  }
}

/// Consecutive clusters of the soil for each thread, with as many neighbours as those of the others.
void VectorisedFlow::share_out() {
  const auto threads = static_cast<std::size_t>(omp_get_max_threads());
  const std::size_t clusters = flow_.soil_clusters.size() - 1;
  const auto border = [&](std::size_t t) {
    const auto work = work_.back() * t / threads;
    const auto chunk = static_cast<std::size_t>(std::upper_bound(work_.begin(), work_.end(), work) - work_.begin()) - 1;
    if (chunk + 1 == work_.size()) return clusters;
    const std::size_t within = ClusterList::chunk_size * (work - work_[chunk]) / (work_[chunk + 1] - work_[chunk]);
    return std::min(ClusterList::chunk_size * chunk + within, clusters);
  };
  shares_.resize(threads);
  for (std::size_t t = 0; t < threads; ++t)
    shares_[t] = {.begin = border(t), .end = border(t + 1), .stress = border(t), .momentum = border(t)};
}

/// Calls f(clusters) for those of the calling thread's share, then for what the others have left of theirs: a thread
/// that the machine holds up does not hold up the rest. Many clusters at a time, few towards the end, so that all end
/// together. Makes the share of the other pass whole again, which a barrier must part from this one. Inside a parallel
/// region.
template <class F>
void VectorisedFlow::for_clusters(std::size_t Share::*next, std::size_t Share::*other, F&& f) {
  const auto thread = static_cast<std::size_t>(omp_get_thread_num()),
             threads = static_cast<std::size_t>(omp_get_num_threads());
  // There may be fewer threads than shares: OpenMP gives as many as it can.
  for (std::size_t t = thread; t < shares_.size(); t += threads) shares_[t].*other = shares_[t].begin;
  constexpr std::size_t many = 32, few = 8;
  for (std::size_t t = 0; t < shares_.size(); ++t) {
    Share& share = shares_[(thread + t) % shares_.size()];
    const std::atomic_ref<std::size_t> taken(share.*next);
    for (std::size_t c; (c = taken.load(std::memory_order_relaxed)) < share.end;) {
      const std::size_t some = share.end - c > 4 * many ? many : few;
      c = taken.fetch_add(some, std::memory_order_relaxed);
      if (c < share.end) f(Chunk{c, std::min(c + some, share.end)});
    }
  }
}

/// Calls f(particles) for those of the calling thread's share, which are in its caches: loops that move memory rather
/// than compute would lose by taking what others have left. Inside a parallel region, which must wait for the other
/// threads afterwards.
template <class F>
void VectorisedFlow::for_own(std::size_t active, F&& f) {
  const auto thread = static_cast<std::size_t>(omp_get_thread_num()),
             threads = static_cast<std::size_t>(omp_get_num_threads());
  const auto place = [&](std::size_t cluster) { return std::min<std::size_t>(flow_.soil_clusters[cluster], active); };
  for (std::size_t t = thread; t < shares_.size(); t += threads)
    f(Chunk{place(shares_[t].begin), place(shares_[t].end)});
}

/// Inside a parallel region.
void VectorisedFlow::pack_active(const Soil& soil, double ahead) {
  for_own(soil.n_active, [&](Chunk own) { pack_soil(flow_, k_, soil, ahead, own); });
#pragma omp barrier
}

/// Inside a parallel region.
void VectorisedFlow::evaluate_here(Soil& soil, WallParticles& walls, double ahead, bool keep, bool pack,
                                   Stopwatch& watch) {
  if (pack) pack_active(soil, ahead);
#pragma omp master
  watch.lap(times_.update);
  for_clusters(&Share::stress, &Share::momentum, [&](Chunk some) { stress_pass(flow_, k_, soil, ahead, keep, some); });
#pragma omp barrier
#pragma omp master
  watch.lap(times_.gradient);
#pragma omp for schedule(static)
  for (std::size_t c = 0; c < flow_.wall_soil.chunks.size(); ++c) wall_stress_pass(flow_, k_, walls, c);
#pragma omp master
  watch.lap(times_.walls);
  for_clusters(&Share::momentum, &Share::stress, [&](Chunk some) { momentum_pass(flow_, k_, some); });
#pragma omp barrier
#pragma omp master
  watch.lap(times_.momentum);
}

void VectorisedFlow::evaluate(Soil& soil, WallParticles& walls, double ahead, bool keep) {
  Stopwatch watch;
  share_out();
  const bool pack = ahead != 0.0 || !packed_now_;
  packed_now_ = ahead == 0.0;
#pragma omp parallel
  evaluate_here(soil, walls, ahead, keep, pack, watch);
}

Motion VectorisedFlow::step(Soil& soil, WallParticles& walls, double dt, bool rk2) {
  Stopwatch watch;
  share_out();
  Motion motion;
#pragma omp declare reduction(extremes:Motion : omp_out = omp_out.with(omp_in))
#pragma omp parallel reduction(extremes : motion)
  {
    if (rk2) evaluate_here(soil, walls, 0.0, true, !packed_now_, watch);
    evaluate_here(soil, walls, 0.5 * dt, !rk2, true, watch);
    for_own(soil.n_active, [&](Chunk own) { motion = motion.with(move_soil(flow_, k_, soil, dt, rk2, own)); });
  }
  watch.lap(times_.update);
  packed_now_ = true;
  return motion;
}

}  // namespace talus

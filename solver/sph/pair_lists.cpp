// Packing, and the lists of neighbours that the pair loops run over.

#include <algorithm>
#include <bit>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/pair_lists.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Fixed-point coordinates of the first `count` doubles at `from`, as bit patterns.
HWY_INLINE V fixed_point(const double* from, std::size_t count, double lo, double per_quantum) {
  const Doubles dd;
  const hn::Rebind<std::int32_t, HalfD> di;
  HWY_ALIGN double buffer[lanes] = {};
  if (count < lanes) {
    for (std::size_t l = 0; l < count; ++l) buffer[l] = from[l];
    from = buffer;
  }
  const auto half = [&](const double* x) HWY_ATTR {
    return hn::DemoteTo(di, hn::Mul(hn::Sub(hn::LoadU(dd, x), hn::Set(dd, lo)), hn::Set(dd, per_quantum)));
  };
  return hn::BitCast(D(), hn::Combine(DI(), half(from + lanes / 2), half(from)));
}

HWY_ATTR void pack_soil_loop(PackedFlow& f, const FlowConstants& k, const Soil& soil, Chunk chunk) {
  const D d;
  const double per_quantum = 1.0 / f.fixed.quantum, per_c2 = 1.0 / (k.c_s * k.c_s);
  for (std::size_t i = chunk.begin; i < chunk.end; i += lanes) {
    const std::size_t count = std::min(chunk.end - i, lanes);
    HWY_ALIGN float volume[lanes] = {}, shifted[lanes] = {}, rho[lanes] = {}, material[lanes] = {}, q[lanes] = {};
    for (std::size_t l = 0; l < count; ++l) {
      const std::size_t n = i + l;
      const double rho0 = k.laws[static_cast<std::size_t>(soil.material[n])].eos.rho0, q_n = (soil.rho[n] - rho0) / rho0;
      const Vec2 from_lo = soil.position(n) - f.fixed.lo;
      volume[l] = static_cast<float>(soil.m[n] / soil.rho[n]);
      shifted[l] = static_cast<float>(q_n - per_c2 * dot(k.g, from_lo));
      rho[l] = static_cast<float>(soil.rho[n]);
      material[l] = static_cast<float>(soil.material[n]);
      q[l] = static_cast<float>(q_n);
    }
    store_groups(hn::Load(d, volume), hn::Load(d, shifted), hn::Load(d, rho), hn::Load(d, material), f.soil.density.data() + 4 * i, count);
    store_groups(fixed_point(soil.x.data() + i, count, f.fixed.lo.x, per_quantum), fixed_point(soil.y.data() + i, count, f.fixed.lo.y, per_quantum),
                 load_doubles(soil.vx.data() + i, count), load_doubles(soil.vy.data() + i, count), f.soil.motion.data() + 4 * i, count);
    std::copy_n(q, count, f.soil.q.data() + i);
  }
}

struct BoxI {
  std::int32_t x_lo, x_hi, y_lo, y_hi;
};

HWY_INLINE BoxI box_of(const float* groups, std::size_t count) {
  const auto at = [&](std::size_t n) { return std::bit_cast<std::int32_t>(groups[n]); };
  BoxI box{at(0), at(0), at(1), at(1)};
  for (std::size_t l = 1; l < count; ++l) {
    box.x_lo = std::min(box.x_lo, at(4 * l)), box.x_hi = std::max(box.x_hi, at(4 * l));
    box.y_lo = std::min(box.y_lo, at(4 * l + 1)), box.y_hi = std::max(box.y_hi, at(4 * l + 1));
  }
  return box;
}

HWY_ATTR void list_chunk(const FixedPoint& fixed, std::span<const std::uint32_t> first, std::span<const float> targets, const CellList& cells,
                         std::span<const float> sources, double distance, double moved, std::uint32_t nowhere, std::size_t chunk, ClusterList& list) {
  const D d;
  const DI di;
  ClusterList::Chunk& out = list.chunks[chunk];
  const double reach = distance / fixed.quantum;
  const V reach2 = set(1.00001 * reach * reach), zero = hn::Zero(d);
  const std::size_t begin = chunk * ClusterList::chunk_size, end = std::min(begin + ClusterList::chunk_size, first.size() - 1);
  std::size_t used = 0;
  for (std::size_t c = begin; c < end; ++c) {
    out.at[c - begin] = static_cast<std::uint32_t>(used);
    const BoxI box = box_of(targets.data() + 4 * first[c], first[c + 1] - first[c]);
    const auto metres = [&](double x, double y) { return Vec2{fixed.lo.x + fixed.quantum * x, fixed.lo.y + fixed.quantum * y}; };
    const double search = reach + moved / fixed.quantum + 1.0;
    const Box region{metres(box.x_lo - search, box.y_lo - search), metres(box.x_hi + search, box.y_hi + search)};
    const VI x_lo = hn::Set(di, box.x_lo), x_hi = hn::Set(di, box.x_hi), y_lo = hn::Set(di, box.y_lo), y_hi = hn::Set(di, box.y_hi);
    cells.for_ranges(region, [&](std::size_t from, std::size_t to) HWY_ATTR {
      if (out.places.size() < used + (to - from) + 2 * lanes) out.places.resize(2 * (used + (to - from)) + 2 * lanes);
      for (std::size_t j = from; j < to; j += lanes) {
        V xj, yj, u, v;
        hn::LoadInterleaved4(d, sources.data() + 4 * j, xj, yj, u, v);
        const VI x = hn::BitCast(di, xj), y = hn::BitCast(di, yj);
        const V dx = hn::Max(hn::ConvertTo(d, hn::Max(hn::Sub(x_lo, x), hn::Sub(x, x_hi))), zero);
        const V dy = hn::Max(hn::ConvertTo(d, hn::Max(hn::Sub(y_lo, y), hn::Sub(y, y_hi))), zero);
        M near = hn::Lt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), reach2);
        if (to - j < lanes) near = hn::And(near, hn::FirstN(d, to - j));
        // A compressing store to memory is slow on some processors; a whole vector fits behind the end.
        const auto chosen = hn::RebindMask(di, near);
        hn::StoreU(hn::Compress(hn::Iota(di, static_cast<std::int32_t>(j)), chosen), di, reinterpret_cast<std::int32_t*>(out.places.data() + used));
        used += hn::CountTrue(di, chosen);
      }
    });
    if (out.places.size() < used + ClusterList::block) out.places.resize(2 * used + ClusterList::block);
    while (used % ClusterList::block != 0) out.places[used++] = nowhere;
  }
  if (out.places.size() < used + ClusterList::block) out.places.resize(used + ClusterList::block);
  for (std::size_t b = 0; b < ClusterList::block; ++b) out.places[used + b] = nowhere;
  for (std::size_t c = end; c <= begin + ClusterList::chunk_size; ++c) out.at[c - begin] = static_cast<std::uint32_t>(used);
}

std::size_t lanes_in_use() { return lanes; }

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(pack_soil_loop);
HWY_EXPORT(list_chunk);
HWY_EXPORT(lanes_in_use);

std::size_t cluster_size() { return HWY_DYNAMIC_DISPATCH(lanes_in_use)(); }

void pack_soil(PackedFlow& f, const FlowConstants& k, const Soil& soil, Chunk chunk) { HWY_DYNAMIC_DISPATCH(pack_soil_loop)(f, k, soil, chunk); }

void pack_walls(PackedFlow& f, const WallParticles& walls) {
  // Walls beyond the fixed point's box are too far from any soil to matter.
  const auto fixed = [&](double x, double lo) {
    return std::bit_cast<float>(static_cast<std::int32_t>(std::clamp((x - lo) / f.fixed.quantum, 0.0, double{1 << 30})));
  };
  for (std::size_t w = 0; w < walls.size(); ++w) {
    f.walls.place[4 * w] = fixed(walls.x[w], f.fixed.lo.x), f.walls.place[4 * w + 1] = fixed(walls.y[w], f.fixed.lo.y);
    f.walls.place[4 * w + 2] = static_cast<float>(walls.nx[w]), f.walls.place[4 * w + 3] = static_cast<float>(walls.ny[w]);
    f.walls.stress[4 * w + 3] = static_cast<float>(walls.depth[w]);
  }
}

void list_neighbours(const FixedPoint& fixed, std::span<const std::uint32_t> first, std::span<const float> targets, const CellList& cells,
                     std::span<const float> sources, double distance, double moved, std::uint32_t nowhere, std::size_t c, ClusterList& list) {
  HWY_DYNAMIC_DISPATCH(list_chunk)(fixed, first, targets, cells, sources, distance, moved, nowhere, c, list);
}

}  // namespace talus
#endif

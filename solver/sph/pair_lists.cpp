// Packing, moving on, and the lists of neighbours that the pair loops run over.

#include <algorithm>
#include <bit>
#include <cmath>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/pair_lists.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

using DoubleV = hn::Vec<Doubles>;

/// One value of all particles of a vector in double precision: lower and upper half.
struct Wide {
  DoubleV lo, hi;
};
HWY_INLINE Wide load(const double* HWY_RESTRICT from, std::size_t count) {
  const Doubles dd;
  HWY_ALIGN double buffer[lanes] = {};
  if (count < lanes) {
    for (std::size_t l = 0; l < count; ++l) buffer[l] = from[l];
    from = buffer;
  }
  return {hn::LoadU(dd, from), hn::LoadU(dd, from + lanes / 2)};
}
HWY_INLINE void store(Wide v, double* HWY_RESTRICT to, std::size_t count) {
  const Doubles dd;
  if (count == lanes) {
    hn::StoreU(v.lo, dd, to), hn::StoreU(v.hi, dd, to + lanes / 2);
    return;
  }
  HWY_ALIGN double buffer[lanes];
  hn::Store(v.lo, dd, buffer), hn::Store(v.hi, dd, buffer + lanes / 2);
  for (std::size_t l = 0; l < count; ++l) to[l] = buffer[l];
}
HWY_INLINE Wide wide(V v) {
  const Doubles dd;
  return {hn::PromoteTo(dd, hn::LowerHalf(v)), hn::PromoteTo(dd, hn::UpperHalf(HalfD(), v))};
}
HWY_INLINE V narrow(Wide v) {
  const HalfD half;
  return hn::Combine(D(), hn::DemoteTo(half, v.hi), hn::DemoteTo(half, v.lo));
}
HWY_INLINE Wide each(double value) { return {hn::Set(Doubles(), value), hn::Set(Doubles(), value)}; }
HWY_INLINE Wide operator+(Wide a, Wide b) { return {hn::Add(a.lo, b.lo), hn::Add(a.hi, b.hi)}; }
HWY_INLINE Wide operator-(Wide a, Wide b) { return {hn::Sub(a.lo, b.lo), hn::Sub(a.hi, b.hi)}; }
HWY_INLINE Wide operator*(Wide a, Wide b) { return {hn::Mul(a.lo, b.lo), hn::Mul(a.hi, b.hi)}; }
HWY_INLINE Wide operator/(Wide a, Wide b) { return {hn::Div(a.lo, b.lo), hn::Div(a.hi, b.hi)}; }

/// Fixed-point coordinates as bit patterns.
HWY_INLINE V fixed_point(Wide x, double lo, double per_quantum) {
  const hn::Rebind<std::int32_t, HalfD> di;
  const Wide units = (x - each(lo)) * each(per_quantum);
  return hn::BitCast(D(), hn::Combine(DI(), hn::DemoteTo(di, units.hi), hn::DemoteTo(di, units.lo)));
}

HWY_ATTR void pack_soil_loop(PackedFlow& f, const FlowConstants& k, const Soil& soil, double ahead, Chunk chunk) {
  const D d;
  const double per_quantum = 1.0 / f.fixed.quantum;
  const Wide dt = each(ahead), one = each(1.0);
  const Wide gx = each(k.g.x / (k.c_s * k.c_s)), gy = each(k.g.y / (k.c_s * k.c_s));
  for (std::size_t i = chunk.begin; i < chunk.end; i += lanes) {
    const std::size_t count = std::min(chunk.end - i, lanes);
    const auto rate = [&](const std::vector<float>& array) HWY_ATTR { return wide(hn::LoadU(d, array.data() + i)); };
    const auto state = [&](const std::vector<double>& array) HWY_ATTR { return load(array.data() + i, count); };
    HWY_ALIGN double rho0[lanes];
    HWY_ALIGN float material[lanes] = {};
    std::fill_n(rho0, lanes, k.laws[0].eos.rho0);
    if (k.laws.size() > 1)
      for (std::size_t l = 0; l < count; ++l)
        material[l] = static_cast<float>(soil.material[i + l]), rho0[l] = k.laws[static_cast<std::size_t>(soil.material[i + l])].eos.rho0;
    const Wide vx = state(soil.vx), vy = state(soil.vy);
    const Wide x = state(soil.x) + dt * vx, y = state(soil.y) + dt * vy;
    const Wide rho = state(soil.rho) + dt * rate(f.soil.drho);
    const Wide q = rho / load(rho0, lanes) - one;
    const Wide hydrostatic = gx * (x - each(f.fixed.lo.x)) + gy * (y - each(f.fixed.lo.y));
    store_groups(fixed_point(x, f.fixed.lo.x, per_quantum), fixed_point(y, f.fixed.lo.y, per_quantum), narrow(vx + dt * rate(f.soil.ax)),
                 narrow(vy + dt * rate(f.soil.ay)), f.soil.motion.data() + 4 * i, count);
    store_groups(narrow(state(soil.m) / rho), narrow(q - hydrostatic), narrow(rho), hn::Load(d, material), f.soil.density.data() + 4 * i, count);
    hn::StoreU(narrow(q), d, f.soil.q.data() + i);
  }
}

HWY_ATTR Motion move_soil_loop(const PackedFlow& f, Soil& soil, double step, bool middle, Chunk chunk) {
  const D d;
  const Wide dt = each(step), half = each(0.5);
  V farthest = hn::Zero(d), hardest = hn::Zero(d);
  for (std::size_t i = chunk.begin; i < chunk.end; i += lanes) {
    const std::size_t count = std::min(chunk.end - i, lanes);
    const auto move = [&](std::vector<double>& array, const std::vector<float>& rate) HWY_ATTR {
      const Wide from = load(array.data() + i, count), to = from + dt * wide(hn::LoadU(d, rate.data() + i));
      store(to, array.data() + i, count);
      return half * (from + to);
    };
    const Wide mean_vx = move(soil.vx, f.soil.ax), mean_vy = move(soil.vy, f.soil.ay);
    move(soil.rho, f.soil.drho), move(soil.txx, f.soil.dtxx), move(soil.tyy, f.soil.dtyy), move(soil.txy, f.soil.dtxy);
    V x, y, vx, vy;
    hn::LoadInterleaved4(d, f.soil.motion.data() + 4 * i, x, y, vx, vy);
    if (!middle) vx = narrow(mean_vx), vy = narrow(mean_vy);
    store(load(soil.x.data() + i, count) + dt * (middle ? wide(vx) : mean_vx), soil.x.data() + i, count);
    store(load(soil.y.data() + i, count) + dt * (middle ? wide(vy) : mean_vy), soil.y.data() + i, count);
    const V ax = hn::LoadU(d, f.soil.ax.data() + i), ay = hn::LoadU(d, f.soil.ay.data() + i);
    V v2 = hn::MulAdd(vx, vx, hn::Mul(vy, vy)), a2 = hn::MulAdd(ax, ax, hn::Mul(ay, ay));
    if (count < lanes) v2 = hn::IfThenElseZero(hn::FirstN(d, count), v2), a2 = hn::IfThenElseZero(hn::FirstN(d, count), a2);
    farthest = hn::Max(farthest, v2), hardest = hn::Max(hardest, a2);
  }
  const auto root = [&](V squares) HWY_ATTR { return std::sqrt(static_cast<double>(hn::GetLane(hn::MaxOfLanes(d, squares)))); };
  return {step * root(farthest), root(hardest)};
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

/// At least n entries, without the doubling that would cost memory.
inline void make_room(std::vector<std::uint32_t>& places, std::size_t n) {
  if (places.size() >= n) return;
  places.reserve(n + n / 16);
  places.resize(n + n / 16);
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
      make_room(out.places, used + (to - from) + 2 * lanes);
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
    make_room(out.places, used + ClusterList::block);
    while (used % ClusterList::block != 0) out.places[used++] = nowhere;
  }
  make_room(out.places, used + ClusterList::block);
  for (std::size_t b = 0; b < ClusterList::block; ++b) out.places[used + b] = nowhere;
  for (std::size_t c = end; c <= begin + ClusterList::chunk_size; ++c) out.at[c - begin] = static_cast<std::uint32_t>(used);
}

std::size_t lanes_in_use() { return lanes; }

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(pack_soil_loop);
HWY_EXPORT(move_soil_loop);
HWY_EXPORT(list_chunk);
HWY_EXPORT(lanes_in_use);

std::size_t cluster_size() { return HWY_DYNAMIC_DISPATCH(lanes_in_use)(); }

void pack_soil(PackedFlow& f, const FlowConstants& k, const Soil& soil, double ahead, Chunk chunk) {
  HWY_DYNAMIC_DISPATCH(pack_soil_loop)(f, k, soil, ahead, chunk);
}

Motion move_soil(const PackedFlow& f, Soil& soil, double dt, bool middle, Chunk chunk) {
  return HWY_DYNAMIC_DISPATCH(move_soil_loop)(f, soil, dt, middle, chunk);
}

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

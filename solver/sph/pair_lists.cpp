// The instruction set that the pair loops use, and the lists of neighbours that they run over.

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/pair_lists.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

struct BoxI {
  std::int32_t x_lo, x_hi, y_lo, y_hi;
};

HWY_INLINE BoxI box_of(const float* groups, std::size_t count) {
  const auto at = [&](std::size_t n) { return std::bit_cast<std::int32_t>(groups[n]); };
  BoxI box{at(0), at(0), at(1), at(1)};
  for (std::size_t l = 1; l < count; ++l) {
    box.x_lo = std::min(box.x_lo, at(4 * l));
    box.x_hi = std::max(box.x_hi, at(4 * l));
    box.y_lo = std::min(box.y_lo, at(4 * l + 1));
    box.y_hi = std::max(box.y_hi, at(4 * l + 1));
  }
  return box;
}

/// At least n entries, without the doubling that would cost memory.
inline void make_room(std::vector<std::uint32_t>& places, std::size_t n) {
  if (places.size() >= n) return;
  places.reserve(n + n / 16);
  places.resize(n + n / 16);
}

HWY_ATTR void list_batch(const NeighbourSearch& search, std::size_t batch, ClusterList& list) {
  const D d;
  const DI di;
  const FixedPoint& fixed = search.fixed;
  const std::span<const std::uint32_t> first = search.clusters;
  ClusterList::Batch& out = list.batches[batch];
  const double reach = search.distance / fixed.quantum;
  const V reach2 = hn::Set(d, static_cast<float>(1.00001 * reach * reach)), zero = hn::Zero(d);
  const std::size_t begin = batch * ClusterList::batch_size,
                    end = std::min(begin + ClusterList::batch_size, first.size() - 1);
  std::size_t used = 0;
  for (std::size_t c = begin; c < end; ++c) {
    out.at[c - begin] = static_cast<std::uint32_t>(used);
    const BoxI box = box_of(search.targets.data() + 4 * first[c], first[c + 1] - first[c]);
    const auto metres = [&](double x, double y) {
      return Vec2{fixed.lo.x + fixed.quantum * x, fixed.lo.y + fixed.quantum * y};
    };
    const double margin = reach + search.moved / fixed.quantum + 1.0;
    const Box region{metres(box.x_lo - margin, box.y_lo - margin), metres(box.x_hi + margin, box.y_hi + margin)};
    const VI x_lo = hn::Set(di, box.x_lo), x_hi = hn::Set(di, box.x_hi), y_lo = hn::Set(di, box.y_lo),
             y_hi = hn::Set(di, box.y_hi);
    search.cells.for_ranges(region, [&](std::size_t from, std::size_t to) HWY_ATTR {
      make_room(out.places, used + (to - from) + 2 * lanes);
      for (std::size_t j = from; j < to; j += lanes) {
        V xj, yj, u, v;
        hn::LoadInterleaved4(d, search.sources.data() + 4 * j, xj, yj, u, v);
        const VI x = hn::BitCast(di, xj), y = hn::BitCast(di, yj);
        const V dx = hn::Max(hn::ConvertTo(d, hn::Max(hn::Sub(x_lo, x), hn::Sub(x, x_hi))), zero);
        const V dy = hn::Max(hn::ConvertTo(d, hn::Max(hn::Sub(y_lo, y), hn::Sub(y, y_hi))), zero);
        M near = hn::Lt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), reach2);
        if (to - j < lanes) near = hn::And(near, hn::FirstN(d, to - j));
        // A compressing store to memory is slow on some processors; a whole vector fits behind the end.
        const auto chosen = hn::RebindMask(di, near);
        hn::StoreU(hn::Compress(hn::Iota(di, static_cast<std::int32_t>(j)), chosen), di,
                   reinterpret_cast<std::int32_t*>(out.places.data() + used));
        used += hn::CountTrue(di, chosen);
      }
    });
    make_room(out.places, used + ClusterList::block);
    while (used % ClusterList::block != 0) out.places[used++] = search.padding;
  }
  make_room(out.places, used + ClusterList::block);
  for (std::size_t b = 0; b < ClusterList::block; ++b) out.places[used + b] = search.padding;
  for (std::size_t c = end; c <= begin + ClusterList::batch_size; ++c)
    out.at[c - begin] = static_cast<std::uint32_t>(used);
}

std::size_t lanes_in_use() { return lanes; }
const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(list_batch);
HWY_EXPORT(lanes_in_use);
HWY_EXPORT(target_name);

std::size_t cluster_size() { return HWY_DYNAMIC_DISPATCH(lanes_in_use)(); }

bool limit_pair_loops(const std::string& name) {
#if HWY_ARCH_X86
  // The better a set, the lower its bit.
  if (name == "AVX2") hwy::DisableTargets(HWY_AVX2 - 1);
  if (name == "SSE4") hwy::DisableTargets(HWY_SSE4 - 1);
  return name == "AVX2" || name == "SSE4";
#else
  return name.empty();
#endif
}

const char* pair_loops_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

void list_neighbours(const NeighbourSearch& search, std::size_t batch, ClusterList& list) {
  HWY_DYNAMIC_DISPATCH(list_batch)(search, batch, list);
}

}  // namespace talus
#endif

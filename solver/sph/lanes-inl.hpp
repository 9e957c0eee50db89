// Vectors of the pair loops. Included once for every instruction set (Highway's foreach_target), hence the toggled
// guard.

#if defined(TALUS_SPH_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_LANES_INL
#undef TALUS_SPH_LANES_INL
#else
#define TALUS_SPH_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
// Eight lanes, four where the processor has no more. Wider ones carry more neighbours that are too far: see README.md.
using D = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;
using HalfD = hn::Half<D>;
using Doubles = hn::Rebind<double, HalfD>;
constexpr std::size_t lanes = HWY_LANES(float) < 8 ? HWY_LANES(float) : 8;

HWY_INLINE V set(float value) { return hn::Set(D(), value); }
HWY_INLINE V set(double value) { return hn::Set(D(), static_cast<float>(value)); }

/// The first `count` of the doubles at `from`, rounded.
HWY_INLINE V load_doubles(const double* HWY_RESTRICT from, std::size_t count) {
  const Doubles dd;
  const HalfD half;
  HWY_ALIGN double buffer[lanes] = {};
  if (count < lanes) {
    for (std::size_t l = 0; l < count; ++l) buffer[l] = from[l];
    from = buffer;
  }
  return hn::Combine(D(), hn::DemoteTo(half, hn::LoadU(dd, from + lanes / 2)), hn::DemoteTo(half, hn::LoadU(dd, from)));
}

/// Writes the first `count` lanes to the doubles at `to`.
HWY_INLINE void store_doubles(V v, double* HWY_RESTRICT to, std::size_t count) {
  const Doubles dd;
  if (count == lanes) {
    hn::StoreU(hn::PromoteTo(dd, hn::LowerHalf(v)), dd, to);
    hn::StoreU(hn::PromoteTo(dd, hn::UpperHalf(HalfD(), v)), dd, to + lanes / 2);
    return;
  }
  HWY_ALIGN float buffer[lanes];
  hn::Store(v, D(), buffer);
  for (std::size_t l = 0; l < count; ++l) to[l] = static_cast<double>(buffer[l]);
}

/// Adds the first `count` lanes to the doubles at `to`.
HWY_INLINE void add_doubles(V v, double* HWY_RESTRICT to, std::size_t count) {
  const Doubles dd;
  if (count == lanes) {
    hn::StoreU(hn::Add(hn::LoadU(dd, to), hn::PromoteTo(dd, hn::LowerHalf(v))), dd, to);
    hn::StoreU(hn::Add(hn::LoadU(dd, to + lanes / 2), hn::PromoteTo(dd, hn::UpperHalf(HalfD(), v))), dd,
               to + lanes / 2);
    return;
  }
  HWY_ALIGN float buffer[lanes];
  hn::Store(v, D(), buffer);
  for (std::size_t l = 0; l < count; ++l) to[l] += static_cast<double>(buffer[l]);
}

/// Writes the first `count` lanes to `to`.
HWY_INLINE void store(V v, float* HWY_RESTRICT to, std::size_t count) {
  if (count == lanes) {
    hn::StoreU(v, D(), to);
    return;
  }
  HWY_ALIGN float buffer[lanes];
  hn::Store(v, D(), buffer);
  for (std::size_t l = 0; l < count; ++l) to[l] = buffer[l];
}

/// Reads the first `count` groups of four at `from`, and no more: those behind may be another thread's. The other lanes
/// are zero.
HWY_INLINE void load_groups(const float* HWY_RESTRICT from, std::size_t count, V& a, V& b, V& c, V& d) {
  HWY_ALIGN float buffer[4 * lanes] = {};
  if (count < lanes) {
    for (std::size_t l = 0; l < 4 * count; ++l) buffer[l] = from[l];
    from = buffer;
  }
  hn::LoadInterleaved4(D(), from, a, b, c, d);
}

/// Writes the first `count` groups of four to `to`.
HWY_INLINE void store_groups(V a, V b, V c, V d, float* HWY_RESTRICT to, std::size_t count) {
  if (count == lanes) {
    hn::StoreInterleaved4(a, b, c, d, D(), to);
    return;
  }
  HWY_ALIGN float buffer[4 * lanes];
  hn::StoreInterleaved4(a, b, c, d, D(), buffer);
  for (std::size_t l = 0; l < 4 * count; ++l) to[l] = buffer[l];
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Lanes, the number type of the vectorised loops. Included once for every instruction set (Highway's foreach_target),
// hence the toggled guard.

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

/// One value of every particle of a cluster, in single precision. The operations are those of math/number.hpp.
struct Lanes {
  V v;

  Lanes() = default;
  explicit HWY_INLINE Lanes(V value) : v(value) {}
  explicit HWY_INLINE Lanes(float value) : v(hn::Set(D(), value)) {}
  explicit HWY_INLINE Lanes(double value) : Lanes(static_cast<float>(value)) {}

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.v, b.v)); }
  friend HWY_INLINE Lanes fma(Lanes a, Lanes b, Lanes c) { return Lanes(hn::MulAdd(a.v, b.v, c.v)); }
  friend HWY_INLINE Lanes fms(Lanes a, Lanes b, Lanes c) { return Lanes(hn::MulSub(a.v, b.v, c.v)); }
  friend HWY_INLINE Lanes fnma(Lanes a, Lanes b, Lanes c) { return Lanes(hn::NegMulAdd(a.v, b.v, c.v)); }
  friend HWY_INLINE Lanes sqrt(Lanes a) { return Lanes(hn::Sqrt(a.v)); }
  friend HWY_INLINE Lanes abs(Lanes a) { return Lanes(hn::Abs(a.v)); }
  friend HWY_INLINE Lanes min(Lanes a, Lanes b) { return Lanes(hn::Min(a.v, b.v)); }
  friend HWY_INLINE Lanes max(Lanes a, Lanes b) { return Lanes(hn::Max(a.v, b.v)); }

  /// Lanes where a condition holds.
  struct Mask {
    M m;
    friend HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
    friend HWY_INLINE bool any(Mask a) { return !hn::AllFalse(D(), a.m); }
    friend HWY_INLINE Lanes select(Mask where, Lanes a, Lanes b) { return Lanes(hn::IfThenElse(where.m, a.v, b.v)); }
    friend HWY_INLINE Lanes select_or_zero(Mask where, Lanes a) { return Lanes(hn::IfThenElseZero(where.m, a.v)); }
  };
  friend HWY_INLINE Mask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE Mask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE Mask operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }
};

/// The same in double precision: lower and upper half of the lanes.
struct Wide {
  hn::Vec<Doubles> lo, hi;
};
/// Reads the first `count` doubles at `from`; the other lanes are zero.
HWY_INLINE Wide load(const double* HWY_RESTRICT from, std::size_t count) {
  const Doubles dd;
  HWY_ALIGN double buffer[lanes] = {};
  if (count < lanes) {
    for (std::size_t l = 0; l < count; ++l) buffer[l] = from[l];
    from = buffer;
  }
  return {hn::LoadU(dd, from), hn::LoadU(dd, from + lanes / 2)};
}
/// Writes the first `count` lanes to `to`.
HWY_INLINE void store(Wide v, double* HWY_RESTRICT to, std::size_t count) {
  const Doubles dd;
  if (count == lanes) {
    hn::StoreU(v.lo, dd, to);
    hn::StoreU(v.hi, dd, to + lanes / 2);
    return;
  }
  HWY_ALIGN double buffer[lanes];
  hn::Store(v.lo, dd, buffer);
  hn::Store(v.hi, dd, buffer + lanes / 2);
  for (std::size_t l = 0; l < count; ++l) to[l] = buffer[l];
}
HWY_INLINE Wide wide(Lanes a) {
  const Doubles dd;
  return {hn::PromoteTo(dd, hn::LowerHalf(a.v)), hn::PromoteTo(dd, hn::UpperHalf(HalfD(), a.v))};
}
HWY_INLINE Lanes narrow(Wide a) {
  const HalfD half;
  return Lanes(hn::Combine(D(), hn::DemoteTo(half, a.hi), hn::DemoteTo(half, a.lo)));
}
HWY_INLINE Wide each(double value) { return {hn::Set(Doubles(), value), hn::Set(Doubles(), value)}; }
HWY_INLINE Wide operator+(Wide a, Wide b) { return {hn::Add(a.lo, b.lo), hn::Add(a.hi, b.hi)}; }
HWY_INLINE Wide operator-(Wide a, Wide b) { return {hn::Sub(a.lo, b.lo), hn::Sub(a.hi, b.hi)}; }
HWY_INLINE Wide operator*(Wide a, Wide b) { return {hn::Mul(a.lo, b.lo), hn::Mul(a.hi, b.hi)}; }
HWY_INLINE Wide operator/(Wide a, Wide b) { return {hn::Div(a.lo, b.lo), hn::Div(a.hi, b.hi)}; }

/// Writes the first `count` lanes to `to`.
HWY_INLINE void store(Lanes value, float* HWY_RESTRICT to, std::size_t count) {
  if (count == lanes) {
    hn::StoreU(value.v, D(), to);
    return;
  }
  HWY_ALIGN float buffer[lanes];
  hn::Store(value.v, D(), buffer);
  for (std::size_t l = 0; l < count; ++l) to[l] = buffer[l];
}

/// The floats at `from`, as many as there are lanes.
HWY_INLINE Lanes load(const float* HWY_RESTRICT from) { return Lanes(hn::LoadU(D(), from)); }

/// Reads as many groups of four at `from` as there are lanes.
HWY_INLINE void load_groups(const float* HWY_RESTRICT from, Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  hn::LoadInterleaved4(D(), from, a.v, b.v, c.v, d.v);
}
/// Reads the first `count` groups of four at `from`, and no more: those behind may be another thread's. The other lanes
/// are zero.
HWY_INLINE void load_groups(const float* HWY_RESTRICT from, std::size_t count, Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  HWY_ALIGN float buffer[4 * lanes] = {};
  if (count < lanes) {
    for (std::size_t l = 0; l < 4 * count; ++l) buffer[l] = from[l];
    from = buffer;
  }
  hn::LoadInterleaved4(D(), from, a.v, b.v, c.v, d.v);
}

/// Writes the first `count` groups of four to `to`.
HWY_INLINE void store_groups(Lanes a, Lanes b, Lanes c, Lanes d, float* HWY_RESTRICT to, std::size_t count) {
  if (count == lanes) {
    hn::StoreInterleaved4(a.v, b.v, c.v, d.v, D(), to);
    return;
  }
  HWY_ALIGN float buffer[4 * lanes];
  hn::StoreInterleaved4(a.v, b.v, c.v, d.v, D(), buffer);
  for (std::size_t l = 0; l < 4 * count; ++l) to[l] = buffer[l];
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

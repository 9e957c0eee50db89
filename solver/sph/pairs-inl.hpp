// Pairs of a cluster and its neighbours: separations and kernels. Included once for every instruction set.

#if defined(TALUS_SPH_PAIRS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_PAIRS_INL
#undef TALUS_SPH_PAIRS_INL
#else
#define TALUS_SPH_PAIRS_INL
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "sph/flow_constants.hpp"
#include "sph/lanes-inl.hpp"
#include "sph/pair_loops.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Neighbours are taken some at a time, step by step together, and the separations of the next ones are worked out
/// before these are summed: the processor looks ahead too little to see from one pair's square root to the next pair's.
constexpr std::size_t block = ClusterList::block;
struct Block {
  V v[block];
};

/// r_ij in quanta of all particles i of a cluster from a block of particles j: components, squared length, length.
struct Separations {
  Block x, y, s, r;
};
HWY_INLINE Separations separations(V X, V Y, const float* HWY_RESTRICT groups, const std::uint32_t* j) {
  const D d;
  const DI di;
  Separations r;
  for (std::size_t b = 0; b < block; ++b) {
    const float* HWY_RESTRICT group = groups + 4 * std::size_t{j[b]};
    r.x.v[b] = hn::ConvertTo(d, hn::Sub(hn::BitCast(di, X), hn::BitCast(di, set(group[0]))));
    r.y.v[b] = hn::ConvertTo(d, hn::Sub(hn::BitCast(di, Y), hn::BitCast(di, set(group[1]))));
  }
  for (std::size_t b = 0; b < block; ++b) r.s.v[b] = hn::MulAdd(r.x.v[b], r.x.v[b], hn::Mul(r.y.v[b], r.y.v[b]));
  for (std::size_t b = 0; b < block; ++b) r.r.v[b] = hn::Sqrt(r.s.v[b]);
  return r;
}

/// The kernels as functions of the distance in quanta; see sph/kernel.hpp. Both vanish beyond 2h of themselves, so that
/// no lane needs a mask.
struct CubicSplineV {
  V per_h, inner_slope, h2, outer_scale, edge, two;

  explicit CubicSplineV(double quantum_per_h)
      : per_h(set(quantum_per_h)),
        inner_slope(set(1.5 * quantum_per_h)),
        h2(set(1.0 / (quantum_per_h * quantum_per_h))),
        outer_scale(set(std::sqrt(0.5 * quantum_per_h))),
        edge(set(std::sqrt(2.0 / quantum_per_h))),
        two(set(2.0f)) {}

  /// -F h^2/sigma: 2 - 3/2 u for u < 1, (2 - u)^2/(2u) beyond. At r = 0 the second is infinite and not chosen.
  HWY_INLINE void minus_F(const Separations& at, Block& F) const {
    Block w;
    for (std::size_t b = 0; b < block; ++b)
      w.v[b] = hn::Max(hn::NegMulAdd(outer_scale, at.r.v[b], edge), hn::Zero(D()));
    for (std::size_t b = 0; b < block; ++b) {
      const V outer = hn::Div(hn::Mul(w.v[b], w.v[b]), at.r.v[b]);
      F.v[b] = hn::IfThenElse(hn::Lt(at.s.v[b], h2), hn::NegMulAdd(inner_slope, at.r.v[b], two), outer);
    }
  }
  /// W/sigma: 2/3 - u^2 + u^3/2 for u < 1, (2 - u)^3/6 beyond.
  HWY_INLINE V W(V r) const {
    const V u = hn::Mul(per_h, r), w = hn::Max(hn::Sub(two, u), hn::Zero(D()));
    const V inner = hn::MulAdd(hn::Mul(u, u), hn::MulSub(set(0.5f), u, set(1.0f)), set(2.0f / 3.0f));
    return hn::IfThenElse(hn::Lt(u, set(1.0f)), inner, hn::Mul(hn::Mul(w, w), hn::Mul(w, set(1.0f / 6.0f))));
  }
};

struct WendlandC2V {
  V half_per_h;

  explicit WendlandC2V(double quantum_per_h) : half_per_h(set(0.5 * quantum_per_h)) {}

  HWY_INLINE V rest(V r) const { return hn::Max(hn::NegMulAdd(half_per_h, r, set(1.0f)), hn::Zero(D())); }
  /// -F h^2/sigma = 5 (1 - u/2)^3.
  HWY_INLINE void minus_F(const Separations& at, Block& F) const {
    for (std::size_t b = 0; b < block; ++b) {
      const V w = rest(at.r.v[b]);
      F.v[b] = hn::Mul(hn::Mul(set(5.0f), w), hn::Mul(w, w));
    }
  }
  /// W/sigma = (1 - u/2)^4 (2u + 1) = w^4 (5 - 4w).
  HWY_INLINE V W(V r) const {
    const V w = rest(r), w2 = hn::Mul(w, w);
    return hn::Mul(hn::Mul(w2, w2), hn::NegMulAdd(set(4.0f), w, set(5.0f)));
  }
};

/// sigma/h^2 of both kernels: see sph/kernel.hpp.
inline double sigma_h2(const FlowConstants& k) {
  const double shape = k.numerics.kernel == KernelShape::wendland_c2 ? 7.0 / 4.0 : 15.0 / 7.0, h2 = k.h * k.h;
  return shape / (std::numbers::pi * h2 * h2);
}

/// The neighbours of cluster c: sources' places [begin, end).
struct Neighbours {
  const std::uint32_t *begin, *end;
};
HWY_INLINE Neighbours neighbours(const ClusterList& list, std::size_t c) {
  const ClusterList::Chunk& chunk = list.chunks[c / ClusterList::chunk_size];
  const std::size_t k = c % ClusterList::chunk_size;
  return {chunk.places.data() + chunk.at[k], chunk.places.data() + chunk.at[k + 1]};
}

/// Calls f(kernel) with a null pointer to the kernel's type.
template <class F>
void with_kernel(const FlowConstants& k, F&& f) {
  if (k.numerics.kernel == KernelShape::wendland_c2)
    f(static_cast<WendlandC2V*>(nullptr));
  else
    f(static_cast<CubicSplineV*>(nullptr));
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

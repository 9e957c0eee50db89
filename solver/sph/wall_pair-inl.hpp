// Pairs of a cluster and a wall particle. Included once for every instruction set.

#if defined(TALUS_SPH_WALL_PAIR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_WALL_PAIR_INL
#undef TALUS_SPH_WALL_PAIR_INL
#else
#define TALUS_SPH_WALL_PAIR_INL
#endif

#include <hwy/highway.h>

#include "sph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// A soil-wall pair: see sph/wall.hpp.
struct WallPair {
  V distance;  ///< of the soil particle to the wall line [m]
  V vx, vy;    ///< v_ij [m/s]
  V v_dot_r;   ///< [quantum m/s]
};
HWY_INLINE WallPair wall_pair(V x, V y, V vx, V vy, const float* HWY_RESTRICT place, float depth, V quantum, V b_max,
                              bool smooth) {
  WallPair w;
  const V nx = set(place[2]), ny = set(place[3]), depth_j = set(depth);
  w.distance = hn::MulSub(quantum, hn::MulAdd(x, nx, hn::Mul(y, ny)), depth_j);
  const V gap = hn::Max(w.distance, hn::Mul(set(1e-6f), depth_j));
  const V b = hn::Min(b_max, hn::Add(set(1.0f), hn::Div(depth_j, gap)));
  if (smooth) {
    const V normal = hn::Mul(b, hn::MulAdd(vx, nx, hn::Mul(vy, ny)));
    w.vx = hn::Mul(normal, nx), w.vy = hn::Mul(normal, ny);
  } else {
    w.vx = hn::Mul(b, vx), w.vy = hn::Mul(b, vy);
  }
  w.v_dot_r = hn::MulAdd(w.vx, x, hn::Mul(w.vy, y));
  return w;
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

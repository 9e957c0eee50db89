// The pair loop of the vectorised passes. Included once for every instruction set.

#if defined(TALUS_SPH_PAIRS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_PAIRS_INL
#undef TALUS_SPH_PAIRS_INL
#else
#define TALUS_SPH_PAIRS_INL
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <cstdint>

#include "math/tensor-inl.hpp"
#include "sph/lanes-inl.hpp"
#include "sph/pair_loops.hpp"
#include "sph/wall-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// The neighbours of cluster c: sources' places [begin, end).
struct Neighbours {
  const std::uint32_t *begin, *end;
};
HWY_INLINE Neighbours neighbours(const ClusterList& list, std::size_t c) {
  const ClusterList::Batch& batch = list.batches[c / ClusterList::batch_size];
  const std::size_t k = c % ClusterList::batch_size;
  return {batch.places.data() + batch.at[k], batch.places.data() + batch.at[k + 1]};
}

/// Neighbours are taken some at a time, step by step together.
constexpr std::size_t block = ClusterList::block;

/// r_ij in quanta of all particles i of a cluster from a block of particles j.
struct Separations {
  Vector<Lanes> r[block];
  Lanes r2[block], distance[block];
};
/// @param x       positions of the cluster, the bit patterns of integers
/// @param groups  the particles, in groups of four that begin with their positions
HWY_INLINE Separations separations(Vector<Lanes> x, const float* HWY_RESTRICT groups, const std::uint32_t* j) {
  const D d;
  const DI di;
  Separations at;
  for (std::size_t b = 0; b < block; ++b) {
    const float* HWY_RESTRICT group = groups + 4 * std::size_t{j[b]};
    const auto difference = [&](Lanes to, float from) HWY_ATTR {
      return Lanes(hn::ConvertTo(d, hn::Sub(hn::BitCast(di, to.v), hn::BitCast(di, Lanes(from).v))));
    };
    at.r[b] = {difference(x.x, group[0]), difference(x.y, group[1])};
  }
  for (std::size_t b = 0; b < block; ++b) at.r2[b] = dot(at.r[b], at.r[b]);
  for (std::size_t b = 0; b < block; ++b) at.distance[b] = sqrt(at.r2[b]);
  return at;
}

/// A neighbour j of all particles of a cluster.
struct Pair {
  std::size_t j;
  Vector<Lanes> r;  ///< r_ij [quantum]
  Lanes r2;         ///< r_ij^2 [quantum2]
  Lanes kernel;     ///< value of the kernel
};

/// Calls interact(Pair) for all neighbours of a cluster at x in their order, with kernel(|r|, r^2).
/// `LookAhead`: works out the separations of the next block before this one is summed: the processor looks ahead too
/// little to see from one pair's square root to the next pair's.
template <bool LookAhead, class Kernel, class Interaction>
HWY_INLINE void for_neighbours(Vector<Lanes> x, const float* HWY_RESTRICT groups, Neighbours near, Kernel&& kernel,
                               Interaction&& interact) {
  Separations next;
  if constexpr (LookAhead) next = separations(x, groups, near.begin);
  for (const std::uint32_t* j = near.begin; j != near.end; j += block) {
    if constexpr (!LookAhead) next = separations(x, groups, j);
    const Separations at = next;
    if constexpr (LookAhead) next = separations(x, groups, j + block);
    Lanes value[block];
    for (std::size_t b = 0; b < block; ++b) value[b] = kernel(at.distance[b], at.r2[b]);
    for (std::size_t b = 0; b < block; ++b) interact(Pair{j[b], at.r[b], at.r2[b], value[b]});
  }
}

/// A group of four of the walls' particle j.
HWY_INLINE WallParticle<Lanes> wall_particle(const PackedWalls& walls, std::size_t j) {
  const float* HWY_RESTRICT place = walls.place.data() + 4 * j;
  return {{Lanes(place[2]), Lanes(place[3])},
          Lanes(walls.stress[4 * j + 3]),
          std::bit_cast<std::int32_t>(walls.slip[j]) == std::bit_cast<std::int32_t>(slip_code(WallSlip::free_slip))};
}
/// The stress or strain rate of a group of four (xx, yy, xy, ...).
HWY_INLINE Symmetric<Lanes> tensor_of(const std::vector<float>& groups, std::size_t j) {
  const float* HWY_RESTRICT tensor = groups.data() + 4 * j;
  return {Lanes(tensor[0]), Lanes(tensor[1]), Lanes(tensor[2])};
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

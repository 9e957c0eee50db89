// The load of the soil on some boundaries: the soil-wall terms of the momentum equation once more, summed by boundary.

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/load_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/kernel-inl.hpp"
#include "sph/momentum-inl.hpp"
#include "sph/pairs-inl.hpp"
#include "sph/wall-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Where a particle of a cluster is in the middle of the step [m].
HWY_INLINE Vec2 place_of(const PackedFlow& f, std::size_t i) {
  const auto metres = [&](float bits, double lo) HWY_ATTR {
    return lo + f.fixed.quantum * static_cast<double>(std::bit_cast<std::int32_t>(bits));
  };
  return {metres(f.soil.motion[4 * i], f.fixed.lo.x), metres(f.soil.motion[4 * i + 1], f.fixed.lo.y)};
}

template <class Kernel, bool Quadratic, bool Reconstruct>
HWY_ATTR void load_loop(const PackedFlow& f, const FlowConstants& k, std::int32_t slot, Vec2 about, Range clusters,
                        WallLoad* loads) {
  const double quantum = f.fixed.quantum;
  const Kernel kernel(quantum / k.h);
  const WallForce<Lanes, Quadratic, Reconstruct> force(k, quantum);
  const Lanes to_force(-sigma_h2<Kernel>(k.h) * quantum);
  const auto minus_F = [&](Lanes r, Lanes r2) HWY_ATTR { return kernel.minus_F(r, r2); };
  for (std::size_t c = clusters.begin; c < clusters.end; ++c) {
    loads[c] = {};
    const Neighbours near = neighbours(f.soil_wall, c);
    if (std::none_of(near.begin, near.end, [&](std::uint32_t j) { return f.walls.slot[j] == slot; })) continue;
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    Vector<Lanes> x, v;
    Lanes volume, q, rho, material, p;
    Symmetric<Lanes> s;
    load_groups(f.soil.motion.data() + 4 * i, x.x, x.y, v.x, v.y);
    load_groups(f.soil.density.data() + 4 * i, volume, q, rho, material);
    load_groups(f.soil.stress.data() + 4 * i, s.xx, s.yy, s.xy, p);
    const Lanes of_i = force.viscosity.of_particle(rho);
    Vector<Lanes> sum{Lanes(0.0), Lanes(0.0)};
    Lanes twist(0.0);
    for_neighbours<false>(x, f.walls.place.data(), near, minus_F, [&](const Pair& pair) HWY_ATTR {
      if (f.walls.slot[pair.j] != slot) return;
      const Vector<Lanes> none{Lanes(0.0), Lanes(0.0)};
      const WallTerm<Lanes> term =
          force.term(of_i, rho, v, wall_particle(f.walls, pair.j), pair.kernel, pair.r, pair.r2);
      const Vector<Lanes> one = force.add(none, s, tensor_of(f.walls.stress, pair.j), term, pair.r);
      sum = {sum.x + one.x, sum.y + one.y};
      twist = twist + fms(pair.r.x, one.y, pair.r.y * one.x);
    });
    const Lanes V_to_F = volume * to_force;
    HWY_ALIGN float fx[lanes], fy[lanes], moment[lanes];
    store(V_to_F * sum.x, fx, count);
    store(V_to_F * sum.y, fy, count);
    store(V_to_F * twist, moment, count);
    for (std::size_t l = 0; l < count; ++l) {
      const Vec2 on_soil{static_cast<double>(fx[l]), static_cast<double>(fy[l])};
      loads[c].force += -1.0 * on_soil;
      // The force acts half-way between soil and wall particle, x_i - r_ij/2.
      loads[c].moment -= cross(place_of(f, i + l) - about, on_soil) - 0.5 * quantum * static_cast<double>(moment[l]);
    }
  }
}

void load_dispatch(const PackedFlow& f, const FlowConstants& k, std::int32_t slot, Vec2 about, Range clusters,
                   WallLoad* loads) {
  with_kernel<Lanes>(k.numerics.kernel, [&]<class Kernel>(std::type_identity<Kernel>) {
    with_artificial_viscosity(k.numerics, [&]<bool Quadratic, bool Reconstruct>() {
      load_loop<Kernel, Quadratic, Reconstruct>(f, k, slot, about, clusters, loads);
    });
  });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(load_dispatch);

void load_pass(const PackedFlow& f, const FlowConstants& k, std::int32_t slot, Vec2 about, Range clusters,
               WallLoad* loads) {
  HWY_DYNAMIC_DISPATCH(load_dispatch)(f, k, slot, about, clusters, loads);
}

}  // namespace talus
#endif

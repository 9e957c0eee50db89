// The stress of the walls, extrapolated from the soil (Adami et al. 2012); see sph/wall-inl.hpp.

#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/wall_stress_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/kernel-inl.hpp"
#include "sph/pairs-inl.hpp"
#include "sph/wall-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

template <class Kernel>
HWY_ATTR void wall_stress_loop(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t batch) {
  const double quantum = f.fixed.quantum;
  const Kernel kernel(quantum / k.h);
  const Lanes per_c2(1.0 / (k.c_s * k.c_s));
  const Vector<Lanes> g{Lanes(k.g.x * quantum), Lanes(k.g.y * quantum)};  // of separations in quanta
  const auto W = [&](Lanes r, Lanes) HWY_ATTR { return kernel.W(r); };
  const std::size_t begin = batch * ClusterList::batch_size,
                    end = std::min(begin + ClusterList::batch_size, f.wall_clusters.size() - 1);
  for (std::size_t c = begin; c < end; ++c) {
    const std::size_t i = f.wall_clusters[c], count = f.wall_clusters[c + 1] - i;
    Vector<Lanes> x, normal;
    load_groups(f.walls.place.data() + 4 * i, x.x, x.y, normal.x, normal.y);
    auto sum = WallStressSum<Lanes>::zero();
    for_neighbours<false>(x, f.soil.motion.data(), neighbours(f.wall_soil, c), W, [&](const Pair& pair) HWY_ATTR {
      const Lanes p(f.soil.stress[4 * pair.j + 3]), rho(f.soil.density[4 * pair.j + 2]), q(f.soil.q[pair.j]);
      sum.add(pair.kernel, {stress_of(f.soil.stress, pair.j), p, rho, q}, dot(g, pair.r), per_c2);
    });
    const Lanes slip = load(f.walls.slip.data() + i);
    const WallStress<Lanes> wall =
        sum.value(k.numerics.tension_cutoff, normal, slip == Lanes(slip_code(WallSlip::no_slip)),
                  slip == Lanes(slip_code(WallSlip::free_slip)));
    Lanes sxx, syy, sxy, depth;
    load_groups(f.walls.stress.data() + 4 * i, sxx, syy, sxy, depth);
    store_groups(wall.s.xx, wall.s.yy, wall.s.xy, depth, f.walls.stress.data() + 4 * i, count);
    const auto keep = [&](Lanes value, std::vector<double>& array)
                          HWY_ATTR { store(wide(value), array.data() + i, count); };
    keep(wall.p, walls.p);
    keep(wall.s.xx, walls.sxx);
    keep(wall.s.yy, walls.syy);
    keep(wall.s.xy, walls.sxy);
    keep(wall.density_ratio, walls.density_ratio);
  }
}

void wall_stress_dispatch(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t batch) {
  with_kernel<Lanes>(k.numerics.kernel,
                     [&]<class Kernel>(std::type_identity<Kernel>) { wall_stress_loop<Kernel>(f, k, walls, batch); });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(wall_stress_dispatch);

void wall_stress_pass(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t batch) {
  HWY_DYNAMIC_DISPATCH(wall_stress_dispatch)(f, k, walls, batch);
}

}  // namespace talus
#endif

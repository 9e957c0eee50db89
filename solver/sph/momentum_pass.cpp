// The second pass over the soil: acceleration ([Z20] Eq. 2).

#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/momentum_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/kernel-inl.hpp"
#include "sph/momentum-inl.hpp"
#include "sph/pairs-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

template <class Kernel, bool Quadratic>
HWY_ATTR void momentum_loop(PackedFlow& f, const FlowConstants& k, Range clusters) {
  const double quantum = f.fixed.quantum;
  const Kernel kernel(quantum / k.h);
  const ArtificialViscosity<Lanes, Quadratic> viscosity(k, quantum);
  const WallLaw<Lanes> wall(k.walls, quantum);
  const Lanes volume_w(k.dx * k.dx), to_force(-sigma_h2<Kernel>(k.h) * quantum);
  const Vector<Lanes> g{Lanes(k.g.x), Lanes(k.g.y)};
  const auto minus_F = [&](Lanes r, Lanes r2) HWY_ATTR { return kernel.minus_F(r, r2); };
  for (std::size_t c = clusters.begin; c < clusters.end; ++c) {
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    Vector<Lanes> x, v;
    Lanes volume, q, rho, material, p;
    Symmetric<Lanes> s;
    load_groups(f.soil.motion.data() + 4 * i, x.x, x.y, v.x, v.y);
    load_groups(f.soil.density.data() + 4 * i, volume, q, rho, material);
    load_groups(f.soil.stress.data() + 4 * i, s.xx, s.yy, s.xy, p);
    const Lanes viscosity_of_i = viscosity.of_particle(rho);
    Vector<Lanes> sum{Lanes(0.0), Lanes(0.0)};
    const auto add_soil = [&](const Pair& pair) HWY_ATTR {
      const float* HWY_RESTRICT motion = f.soil.motion.data() + 4 * pair.j;
      const float* HWY_RESTRICT density = f.soil.density.data() + 4 * pair.j;
      const Lanes VF = Lanes(density[0]) * pair.kernel;
      const Lanes v_dot_r = dot(v - Vector<Lanes>{Lanes(motion[2]), Lanes(motion[3])}, pair.r);
      const Lanes Pi = viscosity(viscosity_of_i, rho, Lanes(density[2]), v_dot_r, pair.r2);
      sum = add_force(sum, s, stress_of(f.soil.stress, pair.j), Pi, VF, pair.r);
    };
    const auto add_wall = [&](const Pair& pair) HWY_ATTR {
      const WallPair<Lanes> w = wall.pair(pair.r, v, wall_particle(f.walls, pair.j));
      Lanes VF = volume_w * pair.kernel;
      if (wall.only_approaching) VF = select_or_zero(w.v_dot_r < Lanes(0.0), VF);
      const Lanes Pi = viscosity(viscosity_of_i, rho, rho, w.v_dot_r, pair.r2);
      sum = add_force(sum, s, stress_of(f.walls.stress, pair.j), Pi, VF, pair.r);
    };
    for_neighbours<true>(x, f.soil.motion.data(), neighbours(f.soil_soil, c), minus_F, add_soil);
    for_neighbours<false>(x, f.walls.place.data(), neighbours(f.soil_wall, c), minus_F, add_wall);
    const Vector<Lanes> a = fma(to_force / rho, sum, g);
    store(a.x, f.soil.ax.data() + i, count);
    store(a.y, f.soil.ay.data() + i, count);
  }
}

void momentum_dispatch(PackedFlow& f, const FlowConstants& k, Range clusters) {
  with_kernel<Lanes>(k.numerics.kernel, [&]<class Kernel>(std::type_identity<Kernel>) {
    if (k.numerics.beta > 0.0)
      momentum_loop<Kernel, true>(f, k, clusters);
    else
      momentum_loop<Kernel, false>(f, k, clusters);
  });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(momentum_dispatch);

void momentum_pass(PackedFlow& f, const FlowConstants& k, Range clusters) {
  HWY_DYNAMIC_DISPATCH(momentum_dispatch)(f, k, clusters);
}

}  // namespace talus
#endif

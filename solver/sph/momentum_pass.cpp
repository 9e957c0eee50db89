// The stress of the walls, extrapolated from the soil (Adami et al. 2012), and the second pass over the soil:
// acceleration ([Z20] Eq. 2).

#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/momentum_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/energy-inl.hpp"
#include "sph/kernel-inl.hpp"
#include "sph/momentum-inl.hpp"
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
      const PackedSoil& soil = f.soil;
      const Lanes p(soil.stress[4 * pair.j + 3]), rho(soil.density[4 * pair.j + 2]), q(soil.q[pair.j]);
      const Lanes cohesion(soil.c[pair.j]), tan_phi(soil.tan_phi[pair.j]);
      sum.add(pair.kernel, {tensor_of(soil.stress, pair.j), p, rho, q, cohesion, tan_phi}, dot(g, pair.r), per_c2);
    });
    const Lanes slip = load(f.walls.slip.data() + i);
    const WallStress<Lanes> wall = sum.value(k, normal, {load(f.walls.c.data() + i), load(f.walls.tan_phi.data() + i)},
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

/// Of a cluster that begins at place i.
HWY_INLINE Symmetric<Lanes> strain_rate(const PackedSoil& soil, std::size_t i) {
  Symmetric<Lanes> e;
  Lanes unused;
  load_groups(soil.strain.data() + 4 * i, e.xx, e.yy, e.xy, unused);
  return e;
}

/// `Reconstruct`: VelocityJump::reconstructed.
template <class Kernel, bool Quadratic, bool Reconstruct, bool Measure>
HWY_ATTR void momentum_loop(PackedFlow& f, const FlowConstants& k, Range clusters) {
  const double quantum = f.fixed.quantum;
  const Kernel kernel(quantum / k.h);
  const ArtificialViscosity<Lanes, Quadratic> viscosity(k, quantum);
  const ReconstructedViscosity<Lanes, Quadratic> reconstructed(k, quantum);
  const WallForce<Lanes, Quadratic, Reconstruct> wall(k, quantum);
  const Lanes to_force(-sigma_h2<Kernel>(k.h) * quantum);
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
    const Symmetric<Lanes> e = Reconstruct ? strain_rate(f.soil, i) : Symmetric<Lanes>{};
    const Lanes viscosity_of_i = viscosity.of_particle(rho);
    Vector<Lanes> sum{Lanes(0.0), Lanes(0.0)};
    auto powers = PairPowers<Lanes>::zero();
    const Lanes reconstructed_of_i = reconstructed.of_particle(rho);
    const auto add_soil = [&](const Pair& pair) HWY_ATTR {
      const float* HWY_RESTRICT motion = f.soil.motion.data() + 4 * pair.j;
      const float* HWY_RESTRICT density = f.soil.density.data() + 4 * pair.j;
      const Lanes VF = Lanes(density[0]) * pair.kernel, rho_j(density[2]);
      const Lanes v_dot_r = dot(v - Vector<Lanes>{Lanes(motion[2]), Lanes(motion[3])}, pair.r);
      Lanes Pi;
      if constexpr (Reconstruct) {
        const Lanes twice_smooth = dot((e + tensor_of(f.soil.strain, pair.j)) * pair.r, pair.r);
        Pi = reconstructed(reconstructed_of_i, rho_j, v_dot_r, twice_smooth, pair.r2);
      } else {
        Pi = viscosity(viscosity_of_i, rho, rho_j, min(v_dot_r, Lanes(0.0)), pair.r2);
      }
      sum = add_force(sum, s, tensor_of(f.soil.stress, pair.j), Pi, VF, pair.r);
      if constexpr (Measure) powers.add_soil(Pi, VF, v_dot_r);
    };
    const auto add_wall = [&](const Pair& pair) HWY_ATTR {
      const WallTerm<Lanes> term =
          wall.term(viscosity_of_i, rho, v, wall_particle(f.walls, pair.j), pair.kernel, pair.r, pair.r2);
      const Symmetric<Lanes> s_w = tensor_of(f.walls.stress, pair.j);
      sum = wall.add(sum, s, s_w, term, pair.r);
      if constexpr (Measure) powers.add_wall(s, s_w, term.Pi, term.VF, v, term.v_ij, pair.r, term.arm);
    };
    for_neighbours<true>(x, f.soil.motion.data(), neighbours(f.soil_soil, c), minus_F, add_soil);
    for_neighbours<false>(x, f.walls.place.data(), neighbours(f.soil_wall, c), minus_F, add_wall);
    const Vector<Lanes> a = fma(to_force / rho, sum, g);
    store(a.x, f.soil.ax.data() + i, count);
    store(a.y, f.soil.ay.data() + i, count);
    if constexpr (Measure) {
      const Lanes V_to_F = volume * to_force;
      store(powers.taken_by_viscosity(V_to_F), f.powers.artificial_viscosity.data() + i, count);
      store(powers.taken_by_boundaries(V_to_F), f.powers.boundaries.data() + i, count);
    }
  }
}

void momentum_dispatch(PackedFlow& f, const FlowConstants& k, bool measure, Range clusters) {
  with_kernel<Lanes>(k.numerics.kernel, [&]<class Kernel>(std::type_identity<Kernel>) {
    with_artificial_viscosity(k.numerics, [&]<bool Quadratic, bool Reconstruct>() {
      if (measure)
        momentum_loop<Kernel, Quadratic, Reconstruct, true>(f, k, clusters);
      else
        momentum_loop<Kernel, Quadratic, Reconstruct, false>(f, k, clusters);
    });
  });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(wall_stress_dispatch);
HWY_EXPORT(momentum_dispatch);

void wall_stress_pass(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t batch) {
  HWY_DYNAMIC_DISPATCH(wall_stress_dispatch)(f, k, walls, batch);
}

void momentum_pass(PackedFlow& f, const FlowConstants& k, bool measure, Range clusters) {
  HWY_DYNAMIC_DISPATCH(momentum_dispatch)(f, k, measure, clusters);
}

}  // namespace talus
#endif

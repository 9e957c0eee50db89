// The first pass over the soil: velocity gradient, density rate, stress ([Z20] Eqs. 1-10).

#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/stress_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/continuity-inl.hpp"
#include "sph/kernel-inl.hpp"
#include "sph/pairs-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// The particles of one cluster, as update_point reads and writes them.
struct ClusterPoint {
  PackedFlow& f;
  const FlowConstants& k;
  Soil& soil;
  double ahead;  ///< [s]
  bool keep, measure;
  std::size_t i, count;
  Lanes volume;  ///< [m3/m]

  HWY_INLINE Lanes q() const { return load(f.soil.q.data() + i); }
  HWY_INLINE Lanes tan_phi() const { return load(f.soil.tan_phi.data() + i); }
  HWY_INLINE Lanes c() const { return load(f.soil.c.data() + i); }
  template <class Get>
  HWY_INLINE Lanes constant(Get&& get) const {
    if (k.soils.size() == 1) return Lanes(get(k.soils[0]));
    HWY_ALIGN float value[lanes] = {};
    for (std::size_t l = 0; l < count; ++l)
      value[l] = static_cast<float>(get(k.soils[static_cast<std::size_t>(soil.material[i + l])]));
    return load(value);
  }
  /// Values that each particle may have of its own.
  template <class Get>
  HWY_INLINE Lanes own_or_constant(const std::vector<double>& own, Get&& get) const {
    return own.empty() ? constant(get) : narrow(load(own.data() + i, count));
  }
  HWY_INLINE Lanes reference_density() const {
    return own_or_constant(soil.rho0, [](const ConstitutiveParameters& of) { return of.eos.rho0; });
  }
  HWY_INLINE Lanes viscosity() const {
    return own_or_constant(soil.eta, [](const ConstitutiveParameters& of) { return of.eta; });
  }
  HWY_INLINE const ClusterPoint& elastic() const { return *this; }
  HWY_INLINE void set_strain_rate(Symmetric<Lanes> e) const {
    const Symmetric<Lanes> over_h = Lanes(f.fixed.quantum * f.fixed.quantum / k.h) * e;
    store_groups(over_h.xx, over_h.yy, over_h.xy, Lanes(0.0), f.soil.strain.data() + 4 * i, count);
  }
  HWY_INLINE void set_stress(Symmetric<Lanes> s, Lanes p) const {
    store_groups(s.xx, s.yy, s.xy, p, f.soil.stress.data() + 4 * i, count);
  }
  HWY_INLINE void set_rates(Lanes drho, Lanes gamma_dot) const {
    store(drho, f.soil.drho.data() + i, count);
    store(gamma_dot, f.soil.gamma_dot.data() + i, count);
  }
  template <class Of>
  HWY_INLINE void set_powers(Of&& of) const {
    if (!measure) return;
    const StressPowers<Lanes> powers = of(volume);
    store(powers.deviator, f.powers.deviator.data() + i, count);
    store(powers.viscosity, f.powers.viscosity.data() + i, count);
    store(powers.density_diffusion, f.powers.density_diffusion.data() + i, count);
  }

  /// The elastic stress after `ahead` at the present rates.
  HWY_INLINE Deviator<Lanes> value() const {
    return fma(Lanes(ahead), Deviator<Lanes>{rate(f.soil.dtxx), rate(f.soil.dtyy), rate(f.soil.dtxy)},
               Deviator<Lanes>{state(soil.txx), state(soil.tyy), state(soil.txy)});
  }
  HWY_INLINE void add(Deviator<Lanes> change) const {
    if (!keep) return;
    const auto add_to = [&](std::vector<double>& array, Lanes value)
                            HWY_ATTR { store(load(array.data() + i, count) + wide(value), array.data() + i, count); };
    add_to(soil.txx, change.xx);
    add_to(soil.tyy, change.yy);
    add_to(soil.txy, change.xy);
  }
  HWY_INLINE void set_rate(Deviator<Lanes> dt) const {
    store(dt.xx, f.soil.dtxx.data() + i, count);
    store(dt.yy, f.soil.dtyy.data() + i, count);
    store(dt.xy, f.soil.dtxy.data() + i, count);
  }

 private:
  HWY_INLINE Lanes rate(const std::vector<float>& array) const { return load(array.data() + i); }
  HWY_INLINE Lanes state(const std::vector<double>& array) const { return narrow(load(array.data() + i, count)); }
};

template <class Kernel, class Model, bool Diffuse, bool OneMaterial, bool ByMass>
HWY_ATTR void stress_loop(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, bool measure,
                          Range clusters) {
  const double quantum = f.fixed.quantum, sigma = sigma_h2<Kernel>(k.h);
  const Kernel kernel(quantum / k.h);
  const Model model(k.rheology);
  const WallLaw<Lanes> wall(k, quantum);
  const Lanes volume_w(k.dx * k.dx), support2(4.0 * k.h * k.h / (quantum * quantum));
  const Lanes to_L(-sigma * quantum), to_diffusion(2.0 * k.numerics.delta * k.h * k.c_s * sigma);
  const auto minus_F = [&](Lanes r, Lanes r2) HWY_ATTR { return kernel.minus_F(r, r2); };
  for (std::size_t c = clusters.begin; c < clusters.end; ++c) {
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    Vector<Lanes> x, v;
    Lanes volume, q, rho, material;
    load_groups(f.soil.motion.data() + 4 * i, x.x, x.y, v.x, v.y);
    load_groups(f.soil.density.data() + 4 * i, volume, q, rho, material);
    const ClusterPoint point{f, k, soil, ahead, keep, measure, i, count, volume};
    MohrCoulomb<Lanes> strength{point.c(), point.tan_phi()};
    const Lanes p = wall.turbulent ? pressure_of(k, point) : Lanes(0.0);
    auto sums = FlowRateSums<Lanes>::zero();
    const auto add_soil = [&](const Pair& pair) HWY_ATTR {
      const float* HWY_RESTRICT motion = f.soil.motion.data() + 4 * pair.j;
      const float* HWY_RESTRICT density = f.soil.density.data() + 4 * pair.j;
      const Lanes VF = Lanes(density[0]) * pair.kernel;
      sums.add(VF, Lanes(density[2]), v - Vector<Lanes>{Lanes(motion[2]), Lanes(motion[3])}, pair.r, ByMass);
      if constexpr (Diffuse) {
        Lanes q_ji = Lanes(density[1]) - q;
        if constexpr (!OneMaterial) q_ji = select_or_zero(Lanes(density[3]) == material, q_ji);
        sums.diffusion = add_diffusion(sums.diffusion, VF, q_ji);
      }
    };
    const auto add_wall = [&](const Pair& pair) HWY_ATTR {
      const WallPair<Lanes> w = wall.pair(pair.r, v, wall_particle(f.walls, pair.j));
      auto acts = pair.r2 < support2;
      if (wall.only_approaching) acts = acts & (w.v_dot_r < Lanes(0.0));
      sums.add(select_or_zero(acts, volume_w * pair.kernel), rho, w.v_ij, pair.r, ByMass);
      if (wall.frictional) {
        const MohrCoulomb<Lanes> of_wall{Lanes(f.walls.c[pair.j]), Lanes(f.walls.tan_phi[pair.j])};
        strength = wall.strength(strength, of_wall, p, acts & (w.distance < wall.thickness));
      }
    };
    for_neighbours<true>(x, f.soil.motion.data(), neighbours(f.soil_soil, c), minus_F, add_soil);
    for_neighbours<false>(x, f.walls.place.data(), neighbours(f.soil_wall, c), minus_F, add_wall);
    update_point(k, model, sums.rates(to_L, to_diffusion, ByMass, rho), strength, point);
  }
}

/// Every choice that the pair loop would otherwise make for each pair is made once.
void stress_dispatch(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, bool measure,
                     Range clusters) {
  with_kernel<Lanes>(k.numerics.kernel, [&]<class Kernel>(std::type_identity<Kernel>) {
    with_constitutive_model<Lanes>(k.rheology, [&]<class Model>(std::type_identity<Model>) {
      const auto run = [&]<bool Diffuse, bool OneMaterial>() {
        if (k.numerics.continuity == Continuity::mass)
          stress_loop<Kernel, Model, Diffuse, OneMaterial, true>(f, k, soil, ahead, keep, measure, clusters);
        else
          stress_loop<Kernel, Model, Diffuse, OneMaterial, false>(f, k, soil, ahead, keep, measure, clusters);
      };
      if (k.numerics.density_filter != DensityFilter::delta_sph)
        run.template operator()<false, true>();
      else if (k.soils.size() == 1)
        run.template operator()<true, true>();
      else
        run.template operator()<true, false>();
    });
  });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(stress_dispatch);

void stress_pass(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, bool measure,
                 Range clusters) {
  HWY_DYNAMIC_DISPATCH(stress_dispatch)(f, k, soil, ahead, keep, measure, clusters);
}

}  // namespace talus
#endif

// The first pass over the soil: velocity gradient, density rate, stress ([Z20] Eqs. 1-10).

#include <cstdint>
#include <limits>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/stress_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/pairs-inl.hpp"
#include "sph/point_law-inl.hpp"
#include "sph/wall_pair-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

template <class Kernel, bool Diffuse, bool OneMaterial, bool ByMass>
HWY_ATTR void stress_loop(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, Chunk clusters) {
  const D d;
  const Kernel kernel(f.fixed.quantum / k.h);
  const V quantum = set(f.fixed.quantum), b_max = set(k.walls.b_max), zero = hn::Zero(d);
  const V volume_w = set(k.dx * k.dx), support2 = set(4.0 * k.h * k.h / (f.fixed.quantum * f.fixed.quantum));
  const V to_L = set(-sigma_h2(k) * f.fixed.quantum),
          to_diffusion = set(2.0 * k.numerics.delta * k.h * k.c_s * sigma_h2(k));
  const bool only_approaching = k.walls.contact == WallContact::approaching,
             smooth = k.walls.slip == WallSlip::free_slip;
  for (std::size_t c = clusters.begin; c < clusters.end; ++c) {
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    V X, Y, vx, vy, volume, q, rho, material;
    hn::LoadInterleaved4(d, f.soil.motion.data() + 4 * i, X, Y, vx, vy);
    hn::LoadInterleaved4(d, f.soil.density.data() + 4 * i, volume, q, rho, material);
    // Sums of V_j (v_j - v_i) r_ij F and V_j (q_j - q_i) F, with -F h^2/sigma for F.
    V Lxx = zero, Lxy = zero, Lyx = zero, Lyy = zero, diffusion = zero;
    V mass = zero;  // of m_j (v_j - v_i).r_ij F
    const Neighbours near = neighbours(f.soil_soil, c);
    Separations next = separations(X, Y, f.soil.motion.data(), near.begin);
    for (const std::uint32_t* j = near.begin; j != near.end; j += block) {
      const Separations r = next;
      next = separations(X, Y, f.soil.motion.data(), j + block);
      Block F;
      kernel.minus_F(r, F);
      for (std::size_t b = 0; b < block; ++b) {
        const float* HWY_RESTRICT motion = f.soil.motion.data() + 4 * std::size_t{j[b]};
        const float* HWY_RESTRICT density = f.soil.density.data() + 4 * std::size_t{j[b]};
        const V x = r.x.v[b], y = r.y.v[b], VF = hn::Mul(set(density[0]), F.v[b]);
        const V wx = hn::Mul(VF, hn::Sub(set(motion[2]), vx)), wy = hn::Mul(VF, hn::Sub(set(motion[3]), vy));
        Lxx = hn::MulAdd(wx, x, Lxx), Lxy = hn::MulAdd(wx, y, Lxy);
        Lyx = hn::MulAdd(wy, x, Lyx), Lyy = hn::MulAdd(wy, y, Lyy);
        if constexpr (ByMass) mass = hn::MulAdd(set(density[2]), hn::MulAdd(wx, x, hn::Mul(wy, y)), mass);
        if constexpr (Diffuse) {
          V dq = hn::Sub(set(density[1]), q);
          if constexpr (!OneMaterial) dq = hn::IfThenElseZero(hn::Eq(set(density[3]), material), dq);
          diffusion = hn::MulAdd(VF, dq, diffusion);
        }
      }
    }
    V distance = set(std::numeric_limits<float>::infinity());
    const Neighbours wall = neighbours(f.soil_wall, c);
    for (const std::uint32_t* j = wall.begin; j != wall.end; j += block) {
      const Separations r = separations(X, Y, f.walls.place.data(), j);
      Block F;
      kernel.minus_F(r, F);
      for (std::size_t b = 0; b < block; ++b) {
        const std::size_t group = 4 * std::size_t{j[b]};
        const V x = r.x.v[b], y = r.y.v[b];
        const WallPair w =
            wall_pair(x, y, vx, vy, f.walls.place.data() + group, f.walls.stress[group + 3], quantum, b_max, smooth);
        M acts = hn::Lt(r.s.v[b], support2);
        if (only_approaching) acts = hn::And(acts, hn::Lt(w.v_dot_r, zero));
        const V VF = hn::IfThenElseZero(acts, hn::Mul(volume_w, F.v[b]));
        const V wx = hn::Mul(VF, w.vx), wy = hn::Mul(VF, w.vy);
        Lxx = hn::NegMulAdd(wx, x, Lxx), Lxy = hn::NegMulAdd(wx, y, Lxy);
        Lyx = hn::NegMulAdd(wy, x, Lyx), Lyy = hn::NegMulAdd(wy, y, Lyy);
        if constexpr (ByMass) mass = hn::NegMulAdd(rho, hn::MulAdd(wx, x, hn::Mul(wy, y)), mass);
        distance = hn::IfThenElse(acts, hn::Min(distance, w.distance), distance);
      }
    }
    // -drho/rho: the trace of L where the volumes of neighbours count, [Z20] Eq. 1 where their masses do.
    const V expansion = ByMass ? hn::Div(hn::Mul(to_L, mass), rho) : hn::Add(hn::Mul(to_L, Lxx), hn::Mul(to_L, Lyy));
    apply_law(f, k, soil, ahead, keep, i, count,
              {hn::Mul(to_L, Lxx), hn::Mul(to_L, Lxy), hn::Mul(to_L, Lyx), hn::Mul(to_L, Lyy), expansion,
               hn::Mul(to_diffusion, diffusion), distance});
  }
}

void stress_dispatch(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, Chunk clusters) {
  with_kernel(k, [&]<class Kernel>(Kernel*) {
    const auto run = [&]<bool Diffuse, bool OneMaterial>() {
      if (k.numerics.continuity == Continuity::mass)
        stress_loop<Kernel, Diffuse, OneMaterial, true>(f, k, soil, ahead, keep, clusters);
      else
        stress_loop<Kernel, Diffuse, OneMaterial, false>(f, k, soil, ahead, keep, clusters);
    };
    if (k.numerics.density_filter != DensityFilter::delta_sph)
      run.template operator()<false, true>();
    else if (k.laws.size() == 1)
      run.template operator()<true, true>();
    else
      run.template operator()<true, false>();
  });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(stress_dispatch);

void stress_pass(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, Chunk clusters) {
  HWY_DYNAMIC_DISPATCH(stress_dispatch)(f, k, soil, ahead, keep, clusters);
}

}  // namespace talus
#endif

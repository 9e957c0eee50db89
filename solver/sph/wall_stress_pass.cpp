// The stress of the walls, extrapolated from the soil (Adami et al. 2012); see sph/wall.hpp.

#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/wall_stress_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/pairs-inl.hpp"
#include "sph/wall.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

template <class Kernel>
HWY_ATTR void wall_stress_loop(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t chunk) {
  const D d;
  const Kernel kernel(f.fixed.quantum / k.h);
  const V zero = hn::Zero(d), per_c2 = set(1.0 / (k.c_s * k.c_s));
  const bool rough = k.walls.slip == WallSlip::no_slip;
  const V gx = set(k.g.x * f.fixed.quantum), gy = set(k.g.y * f.fixed.quantum);  // of separations in quanta
  const std::size_t begin = chunk * ClusterList::chunk_size,
                    end = std::min(begin + ClusterList::chunk_size, f.wall_clusters.size() - 1);
  for (std::size_t c = begin; c < end; ++c) {
    const std::size_t i = f.wall_clusters[c], count = f.wall_clusters[c + 1] - i;
    V X, Y, nx, ny, unused, depth;
    hn::LoadInterleaved4(d, f.walls.place.data() + 4 * i, X, Y, nx, ny);
    V weight = zero, p = zero, p_soil = zero, txx = zero, tyy = zero, txy = zero, compression = zero;
    const Neighbours near = neighbours(f.wall_soil, c);
    for (const std::uint32_t* j = near.begin; j != near.end; j += block) {
      const Separations r = separations(X, Y, f.soil.motion.data(), j);
      for (std::size_t b = 0; b < block; ++b) {
        const float* HWY_RESTRICT stress = f.soil.stress.data() + 4 * std::size_t{j[b]};
        const V W = kernel.W(r.r.v[b]), g_r = hn::MulAdd(gx, r.x.v[b], hn::Mul(gy, r.y.v[b])), p_j = set(stress[3]);
        weight = hn::Add(weight, W);
        p_soil = hn::MulAdd(W, p_j, p_soil);
        p = hn::MulAdd(W, hn::MulAdd(set(f.soil.density[4 * std::size_t{j[b]} + 2]), g_r, p_j), p);
        compression = hn::MulAdd(W, hn::MulAdd(g_r, per_c2, set(f.soil.q[j[b]])), compression);
        txx = hn::MulAdd(W, hn::Add(set(stress[0]), p_j), txx), tyy = hn::MulAdd(W, hn::Add(set(stress[1]), p_j), tyy);
        txy = hn::MulAdd(W, set(stress[2]), txy);
      }
    }
    const M covered = hn::Gt(weight, set(least_weight));
    const V inverse = hn::IfThenElseZero(covered, hn::Div(set(1.0f), weight));
    p = hn::Mul(p, inverse);
    if (k.numerics.tension_cutoff) p = hn::Max(p, zero);
    p_soil = hn::Mul(p_soil, inverse);
    const V growth = hn::Min(hn::Max(hn::Div(p, p_soil), zero), set(3.0f));  // deviator_growth of sph/wall.hpp
    const V share = rough ? hn::Mul(inverse, hn::IfThenElse(hn::Gt(p_soil, zero), growth, set(1.0f))) : inverse;
    V sxx = hn::MulSub(txx, share, p), syy = hn::MulSub(tyy, share, p), sxy = hn::Mul(txy, share);
    if (k.walls.slip == WallSlip::free_slip) {  // mirrored(s, n) of math/tensor.hpp, t = (-ny, nx)
      const V sn_x = hn::MulAdd(sxx, nx, hn::Mul(sxy, ny)), sn_y = hn::MulAdd(sxy, nx, hn::Mul(syy, ny));
      const V two_tn = hn::Mul(set(2.0f), hn::MulSub(nx, sn_y, hn::Mul(ny, sn_x)));
      const V xx = hn::Mul(hn::Mul(two_tn, set(2.0f)), hn::Mul(nx, ny));
      sxx = hn::Add(sxx, xx), syy = hn::Sub(syy, xx);
      sxy = hn::NegMulAdd(two_tn, hn::MulSub(nx, nx, hn::Mul(ny, ny)), sxy);
    }
    V unused_2, unused_3;
    hn::LoadInterleaved4(d, f.walls.stress.data() + 4 * i, unused, unused_2, unused_3, depth);
    store_groups(sxx, syy, sxy, depth, f.walls.stress.data() + 4 * i, count);
    store_doubles(p, walls.p.data() + i, count);
    store_doubles(sxx, walls.sxx.data() + i, count), store_doubles(syy, walls.syy.data() + i, count),
        store_doubles(sxy, walls.sxy.data() + i, count);
    compression = hn::IfThenElseZero(covered, hn::MulAdd(compression, inverse, set(1.0f)));
    store_doubles(compression, walls.compression.data() + i, count);
  }
}

void wall_stress_dispatch(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t chunk) {
  with_kernel(k, [&]<class Kernel>(Kernel*) { wall_stress_loop<Kernel>(f, k, walls, chunk); });
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(wall_stress_dispatch);

void wall_stress_pass(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t c) {
  HWY_DYNAMIC_DISPATCH(wall_stress_dispatch)(f, k, walls, c);
}

}  // namespace talus
#endif

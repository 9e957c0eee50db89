// The second pass over the soil: acceleration ([Z20] Eq. 2).

#include <cstdint>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/momentum_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/pairs-inl.hpp"
#include "sph/wall_pair-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// rho_i rho_j Pi_ij = (rho_i rho_j/rho_mean) mu (beta mu - alpha c_s), mu = h v.r/(r^2 + 0.01 h^2); see
/// sph/artificial_viscosity.hpp.
template <bool Quadratic>
struct Viscous {
  V rho, h_rho, alpha_c, beta, h, soft;  ///< h and 0.01 h^2 in quanta

  Viscous(const FlowConstants& k, double quantum)
      : alpha_c(set(-k.numerics.alpha * k.c_s)),
        beta(set(k.numerics.beta)),
        h(set(k.h / quantum)),
        soft(set(0.01 * k.h * k.h / (quantum * quantum))) {}

  /// Chooses the particles i.
  HWY_INLINE void of(V rho_i) {
    rho = rho_i, h_rho = hn::Mul(hn::Mul(set(2.0f), h), rho_i);
    if constexpr (!Quadratic) h_rho = hn::Mul(h_rho, alpha_c);
  }

  HWY_INLINE V operator()(V v_dot_r, V s, V rho_j) const {
    const V approach = hn::Min(v_dot_r, hn::Zero(D())), soft_s = hn::Add(s, soft);
    const V share = hn::Div(rho_j, hn::Mul(hn::Add(rho, rho_j), soft_s));
    const V linear = hn::Mul(hn::Mul(h_rho, approach), share);  // rho_i rho_j/rho_mean mu
    if constexpr (!Quadratic) return linear;                    // with -alpha c_s
    return hn::Mul(linear, hn::MulAdd(beta, hn::Div(hn::Mul(h, approach), soft_s), alpha_c));
  }
};

template <class Kernel, bool Quadratic>
HWY_ATTR void momentum_loop(PackedFlow& f, const FlowConstants& k, Chunk clusters) {
  const D d;
  const Kernel kernel(f.fixed.quantum / k.h);
  Viscous<Quadratic> viscous(k, f.fixed.quantum);
  const V quantum = set(f.fixed.quantum), b_max = set(k.walls.b_max), zero = hn::Zero(d), volume_w = set(k.dx * k.dx);
  const V to_force = set(-sigma_h2(k) * f.fixed.quantum), gx = set(k.g.x), gy = set(k.g.y);
  const bool only_approaching = k.walls.contact == WallContact::approaching,
             smooth = k.walls.slip == WallSlip::free_slip;
  for (std::size_t c = clusters.begin; c < clusters.end; ++c) {
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    V X, Y, vx, vy, volume, q, rho, material, sxx, syy, sxy, p;
    hn::LoadInterleaved4(d, f.soil.motion.data() + 4 * i, X, Y, vx, vy);
    hn::LoadInterleaved4(d, f.soil.density.data() + 4 * i, volume, q, rho, material);
    hn::LoadInterleaved4(d, f.soil.stress.data() + 4 * i, sxx, syy, sxy, p);
    viscous.of(rho);
    V sum_x = zero, sum_y = zero;  // of V_j (s_i + s_j - rho_i rho_j Pi) r_ij F
    const auto add_force = [&](const float* stress, V Pi, V VF, V x, V y) HWY_ATTR {
      const V xx = hn::Sub(hn::Add(sxx, set(stress[0])), Pi), yy = hn::Sub(hn::Add(syy, set(stress[1])), Pi),
              xy = hn::Add(sxy, set(stress[2]));
      sum_x = hn::MulAdd(VF, hn::MulAdd(xx, x, hn::Mul(xy, y)), sum_x);
      sum_y = hn::MulAdd(VF, hn::MulAdd(xy, x, hn::Mul(yy, y)), sum_y);
    };
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
        const float* HWY_RESTRICT stress = f.soil.stress.data() + 4 * std::size_t{j[b]};
        const V x = r.x.v[b], y = r.y.v[b], VF = hn::Mul(set(density[0]), F.v[b]);
        const V v_dot_r = hn::MulAdd(hn::Sub(vx, set(motion[2])), x, hn::Mul(hn::Sub(vy, set(motion[3])), y));
        const V Pi = viscous(v_dot_r, r.s.v[b], set(density[2]));
        add_force(stress, Pi, VF, x, y);
      }
    }
    const Neighbours wall = neighbours(f.soil_wall, c);
    for (const std::uint32_t* j = wall.begin; j != wall.end; j += block) {
      const Separations r = separations(X, Y, f.walls.place.data(), j);
      Block F;
      kernel.minus_F(r, F);
      for (std::size_t b = 0; b < block; ++b) {
        const std::size_t group = 4 * std::size_t{j[b]};
        const float* HWY_RESTRICT stress = f.walls.stress.data() + group;
        const V x = r.x.v[b], y = r.y.v[b];
        const WallPair w = wall_pair(x, y, vx, vy, f.walls.place.data() + group, stress[3], quantum, b_max, smooth);
        V VF = hn::Mul(volume_w, F.v[b]);
        if (only_approaching) VF = hn::IfThenElseZero(hn::Lt(w.v_dot_r, zero), VF);
        const V Pi = viscous(w.v_dot_r, r.s.v[b], rho);
        add_force(stress, Pi, VF, x, y);
      }
    }
    const V scale = hn::Div(to_force, rho);
    store(hn::MulAdd(scale, sum_x, gx), f.soil.ax.data() + i, count);
    store(hn::MulAdd(scale, sum_y, gy), f.soil.ay.data() + i, count);
  }
}

void momentum_dispatch(PackedFlow& f, const FlowConstants& k, Chunk clusters) {
  with_kernel(k, [&]<class Kernel>(Kernel*) {
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

void momentum_pass(PackedFlow& f, const FlowConstants& k, Chunk clusters) {
  HWY_DYNAMIC_DISPATCH(momentum_dispatch)(f, k, clusters);
}

}  // namespace talus
#endif

#include "sph/pair_loops.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/pair_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/lanes-inl.hpp"
#include "sph/wall.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Neighbours are taken some at a time, step by step together, and the separations of the next ones are worked out before
/// these are summed: the processor looks ahead too little to see from one pair's square root to the next pair's.
constexpr std::size_t block = ClusterList::block;
struct Block {
  V v[block];
};

/// r_ij in quanta of all particles i of a cluster from a block of particles j: components, squared length, length.
struct Separations {
  Block x, y, s, r;
};
HWY_INLINE Separations separations(V X, V Y, const float* HWY_RESTRICT groups, const std::uint32_t* j) {
  const D d;
  const DI di;
  Separations r;
  for (std::size_t b = 0; b < block; ++b) {
    const float* HWY_RESTRICT group = groups + 4 * std::size_t{j[b]};
    r.x.v[b] = hn::ConvertTo(d, hn::Sub(hn::BitCast(di, X), hn::BitCast(di, set(group[0]))));
    r.y.v[b] = hn::ConvertTo(d, hn::Sub(hn::BitCast(di, Y), hn::BitCast(di, set(group[1]))));
  }
  for (std::size_t b = 0; b < block; ++b) r.s.v[b] = hn::MulAdd(r.x.v[b], r.x.v[b], hn::Mul(r.y.v[b], r.y.v[b]));
  for (std::size_t b = 0; b < block; ++b) r.r.v[b] = hn::Sqrt(r.s.v[b]);
  return r;
}

/// The kernels as functions of the distance in quanta; see sph/kernel.hpp. Both vanish beyond 2h of themselves, so that no
/// lane needs a mask.
struct CubicSplineV {
  V per_h, inner_slope, h2, outer_scale, edge, two;

  explicit CubicSplineV(double quantum_per_h)
      : per_h(set(quantum_per_h)),
        inner_slope(set(1.5 * quantum_per_h)),
        h2(set(1.0 / (quantum_per_h * quantum_per_h))),
        outer_scale(set(std::sqrt(0.5 * quantum_per_h))),
        edge(set(std::sqrt(2.0 / quantum_per_h))),
        two(set(2.0f)) {}

  /// -F h^2/sigma: 2 - 3/2 u for u < 1, (2 - u)^2/(2u) beyond. At r = 0 the second is infinite and not chosen.
  HWY_INLINE void minus_F(const Separations& at, Block& F) const {
    Block w;
    for (std::size_t b = 0; b < block; ++b) w.v[b] = hn::Max(hn::NegMulAdd(outer_scale, at.r.v[b], edge), hn::Zero(D()));
    for (std::size_t b = 0; b < block; ++b) {
      const V outer = hn::Div(hn::Mul(w.v[b], w.v[b]), at.r.v[b]);
      F.v[b] = hn::IfThenElse(hn::Lt(at.s.v[b], h2), hn::NegMulAdd(inner_slope, at.r.v[b], two), outer);
    }
  }
  /// W/sigma: 2/3 - u^2 + u^3/2 for u < 1, (2 - u)^3/6 beyond.
  HWY_INLINE V W(V r) const {
    const V u = hn::Mul(per_h, r), w = hn::Max(hn::Sub(two, u), hn::Zero(D()));
    const V inner = hn::MulAdd(hn::Mul(u, u), hn::MulSub(set(0.5f), u, set(1.0f)), set(2.0f / 3.0f));
    return hn::IfThenElse(hn::Lt(u, set(1.0f)), inner, hn::Mul(hn::Mul(w, w), hn::Mul(w, set(1.0f / 6.0f))));
  }
};

struct WendlandC2V {
  V half_per_h;

  explicit WendlandC2V(double quantum_per_h) : half_per_h(set(0.5 * quantum_per_h)) {}

  HWY_INLINE V rest(V r) const { return hn::Max(hn::NegMulAdd(half_per_h, r, set(1.0f)), hn::Zero(D())); }
  /// -F h^2/sigma = 5 (1 - u/2)^3.
  HWY_INLINE void minus_F(const Separations& at, Block& F) const {
    for (std::size_t b = 0; b < block; ++b) {
      const V w = rest(at.r.v[b]);
      F.v[b] = hn::Mul(hn::Mul(set(5.0f), w), hn::Mul(w, w));
    }
  }
  /// W/sigma = (1 - u/2)^4 (2u + 1) = w^4 (5 - 4w).
  HWY_INLINE V W(V r) const {
    const V w = rest(r), w2 = hn::Mul(w, w);
    return hn::Mul(hn::Mul(w2, w2), hn::NegMulAdd(set(4.0f), w, set(5.0f)));
  }
};

/// sigma/h^2 of both kernels: see sph/kernel.hpp.
inline double sigma_h2(const FlowConstants& k) {
  const double shape = k.numerics.kernel == KernelShape::wendland_c2 ? 7.0 / 4.0 : 15.0 / 7.0, h2 = k.h * k.h;
  return shape / (std::numbers::pi * h2 * h2);
}

/// The neighbours of cluster c: sources' places [begin, end).
struct Neighbours {
  const std::uint32_t *begin, *end;
};
HWY_INLINE Neighbours neighbours(const ClusterList& list, std::size_t c) {
  const ClusterList::Chunk& chunk = list.chunks[c / ClusterList::chunk_size];
  const std::size_t k = c % ClusterList::chunk_size;
  return {chunk.places.data() + chunk.at[k], chunk.places.data() + chunk.at[k + 1]};
}

/// A soil-wall pair: see sph/wall.hpp.
struct WallPair {
  V distance;   ///< of the soil particle to the wall line [m]
  V vx, vy;     ///< v_ij [m/s]
  V v_dot_r;    ///< [quantum m/s]
};
HWY_INLINE WallPair wall_pair(V x, V y, V vx, V vy, const float* HWY_RESTRICT place, float depth, V quantum, V b_max, bool smooth) {
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

/// xx^2 + yy^2 + zz^2 + 2 xy^2 of a deviatoric tensor; see math/tensor.hpp.
HWY_INLINE V double_dot(V xx, V yy, V xy) {
  const V zz = hn::Add(xx, yy);
  return hn::MulAdd(xx, xx, hn::MulAdd(yy, yy, hn::MulAdd(zz, zz, hn::Mul(set(2.0f), hn::Mul(xy, xy)))));
}

/// A constant of the law for each particle of a cluster.
template <class Get>
HWY_INLINE V by_material(const FlowConstants& k, const Soil& soil, std::size_t i, std::size_t count, Get&& get) {
  if (k.laws.size() == 1) return set(get(k.laws[0]));
  HWY_ALIGN float value[lanes] = {};
  for (std::size_t l = 0; l < count; ++l) value[l] = static_cast<float>(get(k.laws[static_cast<std::size_t>(soil.material[i + l])]));
  return hn::Load(D(), value);
}

/// What the sums of a cluster give to its law.
struct RatesV {
  V Lxx, Lxy, Lyx, Lyy;  ///< velocity gradient [1/s]
  V diffusion;           ///< 2 delta h c_s sum ..., of rho/rho0 [1/s]
  V wall_distance;       ///< to the nearest acting wall particle's line [m]
};

/// The law of the particles of one cluster, from i; RightHandSide::apply_law is its oracle.
HWY_INLINE void apply_law(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, std::size_t i, std::size_t count,
                          const RatesV& rates) {
  const D d;
  const auto constant = [&](auto&& get) { return by_material(k, soil, i, count, get); };
  const V zero = hn::Zero(d), one = set(1.0f), third = set(1.0 / 3.0);
  const V trace = hn::Add(rates.Lxx, rates.Lyy);
  const V exx = hn::NegMulAdd(third, trace, rates.Lxx), eyy = hn::NegMulAdd(third, trace, rates.Lyy);
  const V exy = hn::Mul(set(0.5f), hn::Add(rates.Lxy, rates.Lyx));
  const bool as_printed = k.rheology.shear_rate == ShearRate::paper;
  const V gamma_dot = hn::Sqrt(hn::Mul(set(as_printed ? 2.0 / 3.0 : 2.0), double_dot(exx, eyy, exy)));
  // p = B ((1 + q)^7 - 1), without cancellation.
  const V q = hn::LoadU(d, f.soil.q.data() + i);
  V sum = hn::Add(q, set(7.0f));
  for (const float c : {21.0f, 35.0f, 35.0f, 21.0f, 7.0f}) sum = hn::MulAdd(q, sum, set(c));
  V p = hn::Mul(hn::Mul(constant([](const PointLaw& law) { return law.eos.B; }), q), sum);
  if (k.numerics.tension_cutoff) p = hn::Max(p, zero);
  V tan_phi = load_doubles(soil.tan_phi.data() + i, count);
  if (k.walls.slip == WallSlip::friction)
    tan_phi = hn::IfThenElse(hn::Lt(rates.wall_distance, set(interface_thickness(k.h))), hn::Min(tan_phi, set(std::tan(k.walls.phi))), tan_phi);
  const V tau_y = hn::MulAdd(hn::Max(p, zero), tan_phi, constant([](const PointLaw& law) { return law.c; }));
  const V eta = constant([](const PointLaw& law) { return law.bingham.eta; });
  V txx, tyy, txy, viscosity = eta;
  if (k.rheology.yield == Yield::regularized) {
    viscosity = hn::Add(eta, hn::Div(tau_y, hn::Max(gamma_dot, set(k.rheology.gamma_dot_min))));
    txx = tyy = txy = zero;
  } else {
    const V dt = set(ahead);
    const auto stress = [&](const std::vector<double>& t, const std::vector<float>& rate) HWY_ATTR {
      return hn::MulAdd(dt, hn::LoadU(d, rate.data() + i), load_doubles(t.data() + i, count));
    };
    txx = stress(soil.txx, f.soil.dtxx), tyy = stress(soil.tyy, f.soil.dtyy), txy = stress(soil.txy, f.soil.dtxy);
    const V limit = as_printed ? hn::Mul(set(std::numbers::sqrt3), tau_y) : tau_y;
    const V size = hn::Sqrt(hn::Mul(set(0.5f), double_dot(txx, tyy, txy)));
    const M yields = hn::Gt(size, limit);
    if (!hn::AllFalse(d, yields)) {
      const V excess = hn::IfThenElseZero(yields, hn::Sub(hn::Div(limit, size), one));
      const auto give_back = [&](V& t, std::vector<double>& kept) HWY_ATTR {
        const V by = hn::Mul(t, excess);
        t = hn::Add(t, by);
        if (keep) add_doubles(by, kept.data() + i, count);
      };
      give_back(txx, soil.txx), give_back(tyy, soil.tyy), give_back(txy, soil.txy);
    }
    const V two_G = constant([](const PointLaw& law) { return 2.0 * law.G; });
    const V two_spin = hn::Sub(rates.Lxy, rates.Lyx);  // Jaumann, see material/elastoviscoplastic.hpp
    const V turn = hn::Mul(two_spin, txy);
    store(hn::MulAdd(two_G, exx, turn), f.soil.dtxx.data() + i, count);
    store(hn::MulSub(two_G, eyy, turn), f.soil.dtyy.data() + i, count);
    store(hn::MulAdd(two_G, exy, hn::Mul(hn::Mul(set(0.5f), two_spin), hn::Sub(tyy, txx))), f.soil.dtxy.data() + i, count);
  }
  const V two_eta = hn::Add(viscosity, viscosity);
  const V sxx = hn::Sub(hn::MulAdd(two_eta, exx, txx), p), syy = hn::Sub(hn::MulAdd(two_eta, eyy, tyy), p), sxy = hn::MulAdd(two_eta, exy, txy);
  store_groups(sxx, syy, sxy, p, f.soil.stress.data() + 4 * i, count);
  const V rho0 = constant([](const PointLaw& law) { return law.eos.rho0; });
  // drho = -rho tr(L) + rho0 diffusion
  store(hn::Mul(rho0, hn::NegMulAdd(hn::Add(q, one), trace, rates.diffusion)), f.soil.drho.data() + i, count);
  store(gamma_dot, f.soil.gamma_dot.data() + i, count);
}

template <class Kernel, bool Diffuse, bool OneMaterial>
HWY_ATTR void stress_loop(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, std::size_t chunk) {
  const D d;
  const Kernel kernel(f.fixed.quantum / k.h);
  const V quantum = set(f.fixed.quantum), b_max = set(k.walls.b_max), zero = hn::Zero(d);
  const V volume_w = set(k.dx * k.dx), support2 = set(4.0 * k.h * k.h / (f.fixed.quantum * f.fixed.quantum));
  const V to_L = set(-sigma_h2(k) * f.fixed.quantum), to_diffusion = set(2.0 * k.numerics.delta * k.h * k.c_s * sigma_h2(k));
  const bool only_approaching = k.walls.contact == WallContact::approaching, smooth = k.walls.slip == WallSlip::free_slip;
  const std::size_t begin = chunk * ClusterList::chunk_size, end = std::min(begin + ClusterList::chunk_size, f.soil_clusters.size() - 1);
  for (std::size_t c = begin; c < end; ++c) {
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    V X, Y, vx, vy, volume, q, rho, material;
    hn::LoadInterleaved4(d, f.soil.motion.data() + 4 * i, X, Y, vx, vy);
    hn::LoadInterleaved4(d, f.soil.density.data() + 4 * i, volume, q, rho, material);
    // Sums of V_j (v_j - v_i) r_ij F and V_j (q_j - q_i) F, with -F h^2/sigma for F.
    V Lxx = zero, Lxy = zero, Lyx = zero, Lyy = zero, diffusion = zero;
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
        const WallPair w = wall_pair(x, y, vx, vy, f.walls.place.data() + group, f.walls.stress[group + 3], quantum, b_max, smooth);
        M acts = hn::Lt(r.s.v[b], support2);
        if (only_approaching) acts = hn::And(acts, hn::Lt(w.v_dot_r, zero));
        const V VF = hn::IfThenElseZero(acts, hn::Mul(volume_w, F.v[b]));
        const V wx = hn::Mul(VF, w.vx), wy = hn::Mul(VF, w.vy);
        Lxx = hn::NegMulAdd(wx, x, Lxx), Lxy = hn::NegMulAdd(wx, y, Lxy);
        Lyx = hn::NegMulAdd(wy, x, Lyx), Lyy = hn::NegMulAdd(wy, y, Lyy);
        distance = hn::IfThenElse(acts, hn::Min(distance, w.distance), distance);
      }
    }
    apply_law(f, k, soil, ahead, keep, i, count,
              {hn::Mul(to_L, Lxx), hn::Mul(to_L, Lxy), hn::Mul(to_L, Lyx), hn::Mul(to_L, Lyy), hn::Mul(to_diffusion, diffusion), distance});
  }
}

template <class Kernel>
HWY_ATTR void wall_stress_loop(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t chunk) {
  const D d;
  const Kernel kernel(f.fixed.quantum / k.h);
  const V zero = hn::Zero(d), per_c2 = set(1.0 / (k.c_s * k.c_s));
  const bool rough = k.walls.slip == WallSlip::no_slip;
  const V gx = set(k.g.x * f.fixed.quantum), gy = set(k.g.y * f.fixed.quantum);  // of separations in quanta
  const std::size_t begin = chunk * ClusterList::chunk_size, end = std::min(begin + ClusterList::chunk_size, f.wall_clusters.size() - 1);
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
    store_doubles(sxx, walls.sxx.data() + i, count), store_doubles(syy, walls.syy.data() + i, count), store_doubles(sxy, walls.sxy.data() + i, count);
    compression = hn::IfThenElseZero(covered, hn::MulAdd(compression, inverse, set(1.0f)));
    store_doubles(compression, walls.compression.data() + i, count);
  }
}

/// rho_i rho_j Pi_ij = (rho_i rho_j/rho_mean) mu (beta mu - alpha c_s), mu = h v.r/(r^2 + 0.01 h^2); see sph/artificial_viscosity.hpp.
template <bool Quadratic>
struct Viscous {
  V rho, h_rho, alpha_c, beta, h, soft;  ///< h and 0.01 h^2 in quanta

  Viscous(const FlowConstants& k, double quantum)
      : alpha_c(set(-k.numerics.alpha * k.c_s)), beta(set(k.numerics.beta)), h(set(k.h / quantum)), soft(set(0.01 * k.h * k.h / (quantum * quantum))) {}

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
HWY_ATTR void momentum_loop(PackedFlow& f, const FlowConstants& k, std::size_t chunk) {
  const D d;
  const Kernel kernel(f.fixed.quantum / k.h);
  Viscous<Quadratic> viscous(k, f.fixed.quantum);
  const V quantum = set(f.fixed.quantum), b_max = set(k.walls.b_max), zero = hn::Zero(d), volume_w = set(k.dx * k.dx);
  const V to_force = set(-sigma_h2(k) * f.fixed.quantum), gx = set(k.g.x), gy = set(k.g.y);
  const bool only_approaching = k.walls.contact == WallContact::approaching, smooth = k.walls.slip == WallSlip::free_slip;
  const std::size_t begin = chunk * ClusterList::chunk_size, end = std::min(begin + ClusterList::chunk_size, f.soil_clusters.size() - 1);
  for (std::size_t c = begin; c < end; ++c) {
    const std::size_t i = f.soil_clusters[c], count = f.soil_clusters[c + 1] - i;
    V X, Y, vx, vy, volume, q, rho, material, sxx, syy, sxy, p;
    hn::LoadInterleaved4(d, f.soil.motion.data() + 4 * i, X, Y, vx, vy);
    hn::LoadInterleaved4(d, f.soil.density.data() + 4 * i, volume, q, rho, material);
    hn::LoadInterleaved4(d, f.soil.stress.data() + 4 * i, sxx, syy, sxy, p);
    viscous.of(rho);
    V sum_x = zero, sum_y = zero;  // of V_j (s_i + s_j - rho_i rho_j Pi) r_ij F
    const auto add_force = [&](const float* stress, V Pi, V VF, V x, V y) HWY_ATTR {
      const V xx = hn::Sub(hn::Add(sxx, set(stress[0])), Pi), yy = hn::Sub(hn::Add(syy, set(stress[1])), Pi), xy = hn::Add(sxy, set(stress[2]));
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

/// Calls f(kernel) with a null pointer to the kernel's type.
template <class F>
void with_kernel(const FlowConstants& k, F&& f) {
  if (k.numerics.kernel == KernelShape::wendland_c2) f(static_cast<WendlandC2V*>(nullptr));
  else f(static_cast<CubicSplineV*>(nullptr));
}

void stress_dispatch(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, std::size_t chunk) {
  with_kernel(k, [&]<class Kernel>(Kernel*) {
    if (k.numerics.density_filter != DensityFilter::delta_sph) stress_loop<Kernel, false, true>(f, k, soil, ahead, keep, chunk);
    else if (k.laws.size() == 1) stress_loop<Kernel, true, true>(f, k, soil, ahead, keep, chunk);
    else stress_loop<Kernel, true, false>(f, k, soil, ahead, keep, chunk);
  });
}

void wall_stress_dispatch(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t chunk) {
  with_kernel(k, [&]<class Kernel>(Kernel*) { wall_stress_loop<Kernel>(f, k, walls, chunk); });
}

void momentum_dispatch(PackedFlow& f, const FlowConstants& k, std::size_t chunk) {
  with_kernel(k, [&]<class Kernel>(Kernel*) {
    if (k.numerics.beta > 0.0) momentum_loop<Kernel, true>(f, k, chunk);
    else momentum_loop<Kernel, false>(f, k, chunk);
  });
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(stress_dispatch);
HWY_EXPORT(wall_stress_dispatch);
HWY_EXPORT(momentum_dispatch);
HWY_EXPORT(target_name);

bool limit_pair_loops(const std::string& name) {
#if HWY_ARCH_X86
  // The better a set, the lower its bit.
  if (name == "AVX2") hwy::DisableTargets(HWY_AVX2 - 1);
  if (name == "SSE4") hwy::DisableTargets(HWY_SSE4 - 1);
  return name == "AVX2" || name == "SSE4";
#else
  return name.empty();
#endif
}

const char* pair_loops_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

void stress_pass(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, std::size_t c) {
  HWY_DYNAMIC_DISPATCH(stress_dispatch)(f, k, soil, ahead, keep, c);
}

void wall_stress_pass(PackedFlow& f, const FlowConstants& k, WallParticles& walls, std::size_t c) {
  HWY_DYNAMIC_DISPATCH(wall_stress_dispatch)(f, k, walls, c);
}

void momentum_pass(PackedFlow& f, const FlowConstants& k, std::size_t c) { HWY_DYNAMIC_DISPATCH(momentum_dispatch)(f, k, c); }

}  // namespace talus
#endif

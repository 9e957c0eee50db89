// Packing of the particles, and moving them on.

#include <algorithm>
#include <bit>
#include <cmath>

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/pack_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sph/continuity-inl.hpp"
#include "sph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Fixed-point coordinates as bit patterns.
HWY_INLINE Lanes fixed_point(Wide x, double lo, double per_quantum) {
  const hn::Rebind<std::int32_t, HalfD> di;
  const Wide units = (x - each(lo)) * each(per_quantum);
  return Lanes(hn::BitCast(D(), hn::Combine(DI(), hn::DemoteTo(di, units.hi), hn::DemoteTo(di, units.lo))));
}

HWY_INLINE Wide max(Wide a, Wide b) { return {hn::Max(a.lo, b.lo), hn::Max(a.hi, b.hi)}; }
HWY_INLINE Wide min(Wide a, Wide b) { return {hn::Min(a.lo, b.lo), hn::Min(a.hi, b.hi)}; }
HWY_INLINE double largest(Wide a) { return hn::GetLane(hn::MaxOfLanes(Doubles(), hn::Max(a.lo, a.hi))); }
HWY_INLINE double smallest(Wide a) { return hn::GetLane(hn::MinOfLanes(Doubles(), hn::Min(a.lo, a.hi))); }
HWY_INLINE double total(Wide a) { return hn::GetLane(hn::SumOfLanes(Doubles(), hn::Add(a.lo, a.hi))); }

/// What packing reads of the particles of one vector.
struct StateV {
  Wide x, y, vx, vy, rho;
};

/// Packs states as they are.
struct Packer {
  double per_quantum;
  Vector<Wide> g_per_c2;
  Wide mass;
  bool one_mass;

  Packer(const PackedFlow& f, const FlowConstants& k)
      : per_quantum(1.0 / f.fixed.quantum),
        g_per_c2{each(k.g.x / (k.c_s * k.c_s)), each(k.g.y / (k.c_s * k.c_s))},
        mass(each(f.mass.value_or(0.0))),
        one_mass(f.mass) {}

  HWY_INLINE void pack(PackedFlow& f, const FlowConstants& k, const Soil& soil, const StateV& s, std::size_t i,
                       std::size_t count) const {
    HWY_ALIGN double rho0[lanes], least[lanes];
    HWY_ALIGN float material[lanes] = {};
    std::fill_n(rho0, lanes, k.soils[0].eos.rho0);
    if (k.soils.size() > 1)
      for (std::size_t l = 0; l < count; ++l) {
        material[l] = static_cast<float>(soil.material[i + l]);
        rho0[l] = k.soils[static_cast<std::size_t>(soil.material[i + l])].eos.rho0;
      }
    if (!soil.rho0.empty()) std::copy_n(soil.rho0.data() + i, count, rho0);
    std::transform(rho0, rho0 + lanes, least, least_density);
    const Wide q = s.rho / load(rho0, lanes) - each(1.0), rho = pair_density(s.rho, load(least, lanes));
    const Vector<Wide> x{s.x - each(f.fixed.lo.x), s.y - each(f.fixed.lo.y)};
    store_groups(fixed_point(s.x, f.fixed.lo.x, per_quantum), fixed_point(s.y, f.fixed.lo.y, per_quantum), narrow(s.vx),
                 narrow(s.vy), f.soil.motion.data() + 4 * i, count);
    const Wide m = one_mass ? mass : load(soil.m.data() + i, count);
    store_groups(narrow(m / rho), narrow(dynamic_density(q, g_per_c2, x)), narrow(rho), load(material),
                 f.soil.density.data() + 4 * i, count);
    store(narrow(q), f.soil.q.data() + i, count);
  }
};

HWY_ATTR void pack_soil_loop(PackedFlow& f, const FlowConstants& k, const Soil& soil, double ahead, Range range) {
  const Packer packer(f, k);
  const Wide dt = each(ahead);
  for (std::size_t i = range.begin; i < range.end; i += lanes) {
    const std::size_t count = std::min(range.end - i, lanes);
    const auto rate = [&](const std::vector<float>& array) HWY_ATTR { return wide(load(array.data() + i)); };
    const auto state = [&](const std::vector<double>& array) HWY_ATTR { return load(array.data() + i, count); };
    const Wide vx = state(soil.vx), vy = state(soil.vy);
    packer.pack(f, k, soil,
                {state(soil.x) + dt * vx, state(soil.y) + dt * vy, vx + dt * rate(f.soil.ax), vy + dt * rate(f.soil.ay),
                 state(soil.rho) + dt * rate(f.soil.drho)},
                i, count);
  }
}

HWY_ATTR StepExtrema move_soil_loop(PackedFlow& f, const FlowConstants& k, Soil& soil, double step,
                                    bool midpoint_velocity, Range range) {
  const D d;
  const Packer packer(f, k);
  const Wide dt = each(step), half = each(0.5), zero = each(0.0);
  Lanes displacement2(0.0), acceleration2(0.0);
  Wide speed2 = zero, moved2 = zero, min_density = each(1e300), nonfinite = zero, leftmost = each(1e300),
       rightmost = each(-1e300);
  for (std::size_t i = range.begin; i < range.end; i += lanes) {
    const std::size_t count = std::min(range.end - i, lanes);
    const Lanes ax = load(f.soil.ax.data() + i), ay = load(f.soil.ay.data() + i);
    const auto state = [&](const std::vector<double>& array) HWY_ATTR { return load(array.data() + i, count); };
    const auto move = [&](std::vector<double>& array, Wide rate) HWY_ATTR {
      const Wide to = load(array.data() + i, count) + dt * rate;
      store(to, array.data() + i, count);
      return to;
    };
    const auto move_with = [&](std::vector<double>& array, const std::vector<float>& rate)
                               HWY_ATTR { return move(array, wide(load(rate.data() + i))); };
    StateV s;
    const Wide old_vx = state(soil.vx), old_vy = state(soil.vy);
    s.vx = move(soil.vx, wide(ax));
    s.vy = move(soil.vy, wide(ay));
    s.rho = move_with(soil.rho, f.soil.drho);
    move_with(soil.txx, f.soil.dtxx);
    move_with(soil.tyy, f.soil.dtyy);
    move_with(soil.txy, f.soil.dtxy);
    Wide vx = half * (old_vx + s.vx), vy = half * (old_vy + s.vy);
    if (midpoint_velocity) {
      Lanes x, y, middle_vx, middle_vy;
      load_groups(f.soil.motion.data() + 4 * i, count, x, y, middle_vx, middle_vy);
      vx = wide(middle_vx);
      vy = wide(middle_vy);
    }
    s.x = move(soil.x, vx), s.y = move(soil.y, vy);
    packer.pack(f, k, soil, s, i, count);
    const auto moved_from = [&](const std::vector<float>& from, Wide to) HWY_ATTR {
      HWY_ALIGN float buffer[lanes] = {};
      std::copy_n(from.data() + i, count, buffer);
      return to - wide(load(buffer));
    };
    const Wide dx = moved_from(soil.x_sorted, s.x), dy = moved_from(soil.y_sorted, s.y);
    const Lanes vx_n = narrow(vx), vy_n = narrow(vy);
    Lanes displacement2_i = fma(vx_n, vx_n, vy_n * vy_n), acceleration2_i = fma(ax, ax, ay * ay);
    Wide speed2_i = s.vx * s.vx + s.vy * s.vy, moved2_i = dx * dx + dy * dy;
    if (count < lanes) {
      const Lanes::Mask some{hn::FirstN(d, count)};
      displacement2_i = select_or_zero(some, displacement2_i);
      acceleration2_i = select_or_zero(some, acceleration2_i);
      // Lanes without a particle, or with one of another thread's, repeat the first one.
      for (Wide* v : {&s.rho, &s.x, &speed2_i, &moved2_i}) {
        HWY_ALIGN double values[lanes];
        store(*v, values, lanes);
        std::fill(values + count, values + lanes, values[0]);
        *v = load(values, lanes);
      }
    }
    displacement2 = max(displacement2, displacement2_i);
    acceleration2 = max(acceleration2, acceleration2_i);
    speed2 = max(speed2, speed2_i);
    moved2 = max(moved2, moved2_i);
    min_density = min(min_density, s.rho);
    leftmost = min(leftmost, s.x);
    rightmost = max(rightmost, s.x);
    nonfinite = nonfinite + zero * (speed2_i + moved2_i + s.rho);  // stays zero unless something is not finite
  }
  const auto root = [&](Lanes squares)
                        HWY_ATTR { return std::sqrt(static_cast<double>(hn::GetLane(hn::MaxOfLanes(d, squares.v)))); };
  return {step * root(displacement2),
          root(acceleration2),
          std::sqrt(largest(speed2)),
          std::sqrt(largest(moved2)),
          smallest(leftmost),
          largest(rightmost),
          total(nonfinite) == 0.0 && smallest(min_density) > 0.0};
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(pack_soil_loop);
HWY_EXPORT(move_soil_loop);

void pack_soil(PackedFlow& f, const FlowConstants& k, const Soil& soil, double ahead, Range range) {
  HWY_DYNAMIC_DISPATCH(pack_soil_loop)(f, k, soil, ahead, range);
}

StepExtrema move_soil(PackedFlow& f, const FlowConstants& k, Soil& soil, double dt, bool midpoint_velocity,
                      Range range) {
  return HWY_DYNAMIC_DISPATCH(move_soil_loop)(f, k, soil, dt, midpoint_velocity, range);
}

void pack_strength(PackedFlow& f, const Soil& soil) {
  const auto narrow_to = [](double value) { return static_cast<float>(value); };
  std::ranges::transform(soil.c, f.soil.c.begin(), narrow_to);
  std::ranges::transform(soil.tan_phi, f.soil.tan_phi.begin(), narrow_to);
}

void pack_walls(PackedFlow& f, const FlowConstants& k, const WallParticles& walls) {
  // Walls beyond the fixed point's box are too far from any soil to matter.
  const auto fixed = [&](double x, double lo) {
    return std::bit_cast<float>(
        static_cast<std::int32_t>(std::clamp((x - lo) / f.fixed.quantum, 0.0, double{1 << 30})));
  };
  for (std::size_t w = 0; w < walls.size(); ++w) {
    f.walls.place[4 * w] = fixed(walls.x[w], f.fixed.lo.x);
    f.walls.place[4 * w + 1] = fixed(walls.y[w], f.fixed.lo.y);
    f.walls.place[4 * w + 2] = static_cast<float>(walls.nx[w]);
    f.walls.place[4 * w + 3] = static_cast<float>(walls.ny[w]);
    f.walls.stress[4 * w + 3] = static_cast<float>(walls.depth[w]);
    const WallFriction& boundary = k.boundaries[static_cast<std::size_t>(walls.boundary[w])];
    f.walls.slip[w] = slip_code(boundary.slip);
    f.walls.tan_phi[w] = static_cast<float>(boundary.tan_phi);
  }
  pack_wall_cohesion(f, k, walls);
}

void pack_wall_cohesion(PackedFlow& f, const FlowConstants& k, const WallParticles& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w) f.walls.c[w] = static_cast<float>(wall_cohesion(k, walls, w));
}

}  // namespace talus
#endif

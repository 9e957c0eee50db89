// The law of the particles of a cluster: from velocity gradient to stress. Included once for every instruction set.

#if defined(TALUS_SPH_POINT_LAW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_SPH_POINT_LAW_INL
#undef TALUS_SPH_POINT_LAW_INL
#else
#define TALUS_SPH_POINT_LAW_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <numbers>
#include <vector>

#include "sph/flow_constants.hpp"
#include "sph/lanes-inl.hpp"
#include "sph/pair_loops.hpp"
#include "sph/wall.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

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
  for (std::size_t l = 0; l < count; ++l)
    value[l] = static_cast<float>(get(k.laws[static_cast<std::size_t>(soil.material[i + l])]));
  return hn::Load(D(), value);
}

/// What the sums of a cluster give to its law.
struct RatesV {
  V Lxx, Lxy, Lyx, Lyy;  ///< velocity gradient [1/s]
  V expansion;           ///< -drho/rho without diffusion [1/s]
  V diffusion;           ///< 2 delta h c_s sum ..., of rho/rho0 [1/s]
  V wall_distance;       ///< to the nearest acting wall particle's line [m]
};

/// The law of the particles of one cluster, from i; RightHandSide::apply_law is its oracle.
HWY_INLINE void apply_law(PackedFlow& f, const FlowConstants& k, Soil& soil, double ahead, bool keep, std::size_t i,
                          std::size_t count, const RatesV& rates) {
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
    tan_phi = hn::IfThenElse(hn::Lt(rates.wall_distance, set(interface_thickness(k.h))),
                             hn::Min(tan_phi, set(std::tan(k.walls.phi))), tan_phi);
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
    store(hn::MulAdd(two_G, exy, hn::Mul(hn::Mul(set(0.5f), two_spin), hn::Sub(tyy, txx))), f.soil.dtxy.data() + i,
          count);
  }
  const V two_eta = hn::Add(viscosity, viscosity);
  const V sxx = hn::Sub(hn::MulAdd(two_eta, exx, txx), p), syy = hn::Sub(hn::MulAdd(two_eta, eyy, tyy), p),
          sxy = hn::MulAdd(two_eta, exy, txy);
  store_groups(sxx, syy, sxy, p, f.soil.stress.data() + 4 * i, count);
  const V rho0 = constant([](const PointLaw& law) { return law.eos.rho0; });
  // drho = -rho expansion + rho0 diffusion
  store(hn::Mul(rho0, hn::NegMulAdd(hn::Add(q, one), rates.expansion, rates.diffusion)), f.soil.drho.data() + i, count);
  store(gamma_dot, f.soil.gamma_dot.data() + i, count);
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

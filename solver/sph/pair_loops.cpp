#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/pair_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
// Eight lanes everywhere: the same bits on AVX2 and AVX-512.
using D = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

/// F = W'(r)/r over sigma/h^2 at squared distance u2 = (r/h)^2 < 4; see sph/kernel.hpp. Both branches, then choose.
template <bool Wendland>
HWY_INLINE V kernel_F(V u2) {
  const D d;
  const V u = hn::Sqrt(u2);
  if constexpr (Wendland) {
    const V w = hn::NegMulAdd(hn::Set(d, 0.5f), u, hn::Set(d, 1.0f));
    return hn::Mul(hn::Mul(hn::Set(d, -5.0f), w), hn::Mul(w, w));
  } else {
    const V inner = hn::MulSub(hn::Set(d, 1.5f), u, hn::Set(d, 2.0f));
    const V w = hn::Sub(hn::Set(d, 2.0f), u);
    const V outer = hn::Div(hn::Mul(hn::Mul(hn::Set(d, -0.5f), w), w), u);
    return hn::IfThenElse(hn::Lt(u, hn::Set(d, 1.0f)), inner, outer);
  }
}

/// Calls f(k, x, y, u2, near) for every vector of candidates around particle i; x, y are r_ij in units of h.
template <class F>
HWY_INLINE void for_vectors(const PackedSoil& s, const CellList& cells, Vec2 x_i, std::int32_t X_i, std::int32_t Y_i, float per_h, F&& f) {
  const D d;
  const DI di;
  const auto X = hn::Set(di, X_i), Y = hn::Set(di, Y_i);
  const V scale = hn::Set(d, per_h), support2 = hn::Set(d, 4.0f);
  const CellList::Ranges ranges = cells.ranges(x_i);
  for (std::size_t r = 0; r < ranges.count; ++r) {
    const std::size_t end = ranges.end[r];
    for (std::size_t k = ranges.begin[r]; k < end; k += hn::Lanes(d)) {
      const V x = hn::Mul(hn::ConvertTo(d, hn::Sub(X, hn::LoadU(di, s.x.data() + k))), scale);
      const V y = hn::Mul(hn::ConvertTo(d, hn::Sub(Y, hn::LoadU(di, s.y.data() + k))), scale);
      const V u2 = hn::MulAdd(x, x, hn::Mul(y, y));
      M near = hn::Lt(u2, support2);
      if (end - k < hn::Lanes(d)) near = hn::And(near, hn::FirstN(d, end - k));
      f(k, x, y, u2, near);
    }
  }
}

template <bool Wendland, bool Diffuse, bool OneMaterial>
HWY_ATTR void gradient_loop(const PackedSoil& s, const CellList& cells, const PairConstants& c, Chunk chunk, const double* px, const double* py,
                            GradientSums& out) {
  const D d;
  const DI di;
  const auto per_h = static_cast<float>(s.quantum / c.h);
  const V gx_h = hn::Set(d, static_cast<float>(c.hydrostatic.x * c.h)), gy_h = hn::Set(d, static_cast<float>(c.hydrostatic.y * c.h));
  const float to_L = c.sigma_h2 * c.h;
  for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
    const V vx = hn::Set(d, s.vx[i]), vy = hn::Set(d, s.vy[i]), q = hn::Set(d, s.q[i]);
    V Lxx = hn::Zero(d), Lxy = Lxx, Lyx = Lxx, Lyy = Lxx, diffusion = Lxx;
    for_vectors(s, cells, {px[i], py[i]}, s.x[i], s.y[i], per_h, [&](std::size_t k, V x, V y, V u2, M near) HWY_ATTR {
      const V VF = hn::IfThenElseZero(near, hn::Mul(hn::LoadU(d, s.V.data() + k), kernel_F<Wendland>(u2)));
      const V wx = hn::Mul(VF, hn::Sub(hn::LoadU(d, s.vx.data() + k), vx)), wy = hn::Mul(VF, hn::Sub(hn::LoadU(d, s.vy.data() + k), vy));
      Lxx = hn::MulAdd(wx, x, Lxx), Lxy = hn::MulAdd(wx, y, Lxy);
      Lyx = hn::MulAdd(wy, x, Lyx), Lyy = hn::MulAdd(wy, y, Lyy);
      if constexpr (Diffuse) {
        // q_j - q_i - q^H, q^H = g.r_ji/c_s^2 = -g.r_ij/c_s^2
        V dq = hn::Sub(hn::LoadU(d, s.q.data() + k), q);
        dq = hn::MulAdd(gx_h, x, hn::MulAdd(gy_h, y, dq));
        if constexpr (!OneMaterial)
          dq = hn::IfThenElseZero(hn::RebindMask(d, hn::Eq(hn::LoadU(di, s.material.data() + k), hn::Set(di, s.material[i]))), dq);
        // The particle itself: q_j - q_i = 0 and r_ij = 0.
        diffusion = hn::NegMulAdd(VF, dq, diffusion);
      }
    });
    out.Lxx[i] = to_L * hn::GetLane(hn::SumOfLanes(d, Lxx)), out.Lxy[i] = to_L * hn::GetLane(hn::SumOfLanes(d, Lxy));
    out.Lyx[i] = to_L * hn::GetLane(hn::SumOfLanes(d, Lyx)), out.Lyy[i] = to_L * hn::GetLane(hn::SumOfLanes(d, Lyy));
    if constexpr (Diffuse) out.diffusion[i] = c.sigma_h2 * hn::GetLane(hn::SumOfLanes(d, diffusion));
  }
}

template <bool Wendland>
HWY_ATTR void momentum_loop(const PackedSoil& s, const CellList& cells, const PairConstants& c, Chunk chunk, const double* px, const double* py,
                            double* ax, double* ay) {
  const D d;
  const auto per_h = static_cast<float>(s.quantum / c.h);
  const V beta = hn::Set(d, c.beta), alpha_c = hn::Set(d, c.alpha_c), zero = hn::Zero(d);
  for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
    const V vx = hn::Set(d, s.vx[i]), vy = hn::Set(d, s.vy[i]), rho = hn::Set(d, s.rho[i]);
    const V sxx = hn::Set(d, s.sxx[i]), syy = hn::Set(d, s.syy[i]), sxy = hn::Set(d, s.sxy[i]);
    V sum_x = zero, sum_y = zero;
    for_vectors(s, cells, {px[i], py[i]}, s.x[i], s.y[i], per_h, [&](std::size_t k, V x, V y, V u2, M near) HWY_ATTR {
      const V VF = hn::IfThenElseZero(near, hn::Mul(hn::LoadU(d, s.V.data() + k), kernel_F<Wendland>(u2)));
      // mu = v.r/(r^2 + 0.01 h^2) with r in units of h; approaching pairs only.
      // rho_i rho_j Pi = rho_i rho_j (-alpha c mu + beta mu^2) / ((rho_i + rho_j)/2); both quotients share one division.
      const V v_dot_r = hn::MulAdd(hn::Sub(vx, hn::LoadU(d, s.vx.data() + k)), x, hn::Mul(hn::Sub(vy, hn::LoadU(d, s.vy.data() + k)), y));
      const V rho_j = hn::LoadU(d, s.rho.data() + k);
      const V sum_rho = hn::Add(rho, rho_j), distance2 = hn::Add(u2, hn::Set(d, 0.01f));
      const V inverse = hn::Div(hn::Set(d, 1.0f), hn::Mul(sum_rho, distance2));
      const V mu = hn::Mul(hn::Min(v_dot_r, zero), hn::Mul(sum_rho, inverse));
      const V harmonic = hn::Mul(hn::Mul(hn::Add(rho, rho), rho_j), hn::Mul(distance2, inverse));
      const V viscous = hn::Mul(harmonic, hn::Mul(mu, hn::MulSub(beta, mu, alpha_c)));
      const V xx = hn::Sub(hn::Add(sxx, hn::LoadU(d, s.sxx.data() + k)), viscous);
      const V yy = hn::Sub(hn::Add(syy, hn::LoadU(d, s.syy.data() + k)), viscous);
      const V xy = hn::Add(sxy, hn::LoadU(d, s.sxy.data() + k));
      sum_x = hn::MulAdd(VF, hn::MulAdd(xx, x, hn::Mul(xy, y)), sum_x);
      sum_y = hn::MulAdd(VF, hn::MulAdd(xy, x, hn::Mul(yy, y)), sum_y);
    });
    const double scale = static_cast<double>(c.sigma_h2 * c.h) / static_cast<double>(s.rho[i]);
    ax[i] = scale * static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum_x)));
    ay[i] = scale * static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum_y)));
  }
}

void gradient_dispatch(const PackedSoil& s, const CellList& cells, const PairConstants& c, Chunk chunk, const double* px, const double* py, GradientSums& out) {
  const auto with = [&](auto wendland) {
    constexpr bool W = decltype(wendland)::value;
    if (!c.diffuse) gradient_loop<W, false, true>(s, cells, c, chunk, px, py, out);
    else if (c.one_material) gradient_loop<W, true, true>(s, cells, c, chunk, px, py, out);
    else gradient_loop<W, true, false>(s, cells, c, chunk, px, py, out);
  };
  c.wendland ? with(std::true_type{}) : with(std::false_type{});
}

void momentum_dispatch(const PackedSoil& s, const CellList& cells, const PairConstants& c, Chunk chunk, const double* px, const double* py, double* ax,
                       double* ay) {
  if (c.wendland) momentum_loop<true>(s, cells, c, chunk, px, py, ax, ay);
  else momentum_loop<false>(s, cells, c, chunk, px, py, ax, ay);
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(gradient_dispatch);
HWY_EXPORT(momentum_dispatch);
HWY_EXPORT(target_name);

const char* pair_loops_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

void gradient_sums(const PackedSoil& packed, const Soil& soil, const CellList& cells, const PairConstants& k, Chunk chunk, GradientSums& out) {
  HWY_DYNAMIC_DISPATCH(gradient_dispatch)(packed, cells, k, chunk, soil.x.data(), soil.y.data(), out);
}

void momentum_sums(const PackedSoil& packed, Soil& soil, const CellList& cells, const PairConstants& k, Chunk chunk) {
  HWY_DYNAMIC_DISPATCH(momentum_dispatch)(packed, cells, k, chunk, soil.x.data(), soil.y.data(), soil.ax.data(), soil.ay.data());
}

void GradientSums::resize(std::size_t n) {
  for (auto* array : {&Lxx, &Lxy, &Lyx, &Lyy, &diffusion}) array->resize(n);
}

}  // namespace talus
#endif

#include "sph/right_hand_side.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "material/elastoviscoplastic.hpp"
#include "sph/artificial_viscosity.hpp"
#include "sph/continuity.hpp"
#include "sph/density_filter.hpp"
#include "sph/momentum.hpp"
#include "sph/velocity_gradient.hpp"
#include "sph/wall.hpp"

namespace talus {
namespace {

constexpr std::size_t chunk_size = 128;  ///< particles that a thread takes at a time

/// Calls f(j, r_ij, r2) for every j of `cells` within the kernel's support of x_i, itself included, in the order of the
/// cells.
template <class Points, class F>
inline void for_neighbours(const CellList& cells, const Points& points, Vec2 x_i, double support2, F&& f) {
  cells.for_ranges(x_i, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const Vec2 r{x_i.x - points.x[j], x_i.y - points.y[j]};
      const double r2 = norm2(r);
      if (r2 < support2) f(j, r, r2);
    }
  });
}

/// Distance of a soil particle to the wall line, by the tangent at the wall particle's foot [m].
double distance_to_wall(const WallParticles& walls, std::size_t j, Vec2 r_ij) {
  return dot(r_ij, walls.normal(j)) - walls.depth[j];
}

}  // namespace

RightHandSide::RightHandSide(FlowConstants constants)
    : k_(std::move(constants)), tan_phi_wall_(std::tan(k_.walls.phi)) {
  for (const PointLaw& law : k_.laws) rho0_.push_back(law.eos.rho0);
}

/// From the velocity gradient to pressure, stress and the rate of the elastic stress: the law of one point.
void RightHandSide::apply_law(Soil& soil, std::size_t i, const Rates& rates) const {
  const PointLaw& law = k_.laws[static_cast<std::size_t>(soil.material[i])];
  const bool as_printed = k_.rheology.shear_rate == ShearRate::paper;
  const double tan_phi =
      k_.walls.slip == WallSlip::friction
          ? interface_tan_phi(soil.tan_phi[i], tan_phi_wall_, rates.wall_distance, interface_thickness(k_.h))
          : soil.tan_phi[i];
  const Dev e = deviator(strain_rate(rates.L));
  const double p_full = law.eos.pressure(soil.rho[i]);
  const double p = k_.numerics.tension_cutoff ? without_tension(p_full) : p_full;
  const double tau_y = yield_stress(law.c, tan_phi, p);
  const double gamma_dot = as_printed ? shear_rate_paper(e) : shear_rate_consistent(e);
  Dev t;
  if (k_.rheology.yield == Yield::regularized) {
    t = law.bingham.stress(tau_y, e, gamma_dot);
  } else {
    // Eq. 7 as printed shears at sqrt(3) tau_y; the elastic law follows it.
    const Dev elastic = return_to_yield(soil.t(i), as_printed ? std::numbers::sqrt3 * tau_y : tau_y);
    soil.txx[i] = elastic.xx, soil.tyy[i] = elastic.yy, soil.txy[i] = elastic.xy;
    const Dev rate = elastic_rate(elastic, e, spin(rates.L), law.G);
    soil.dtxx[i] = rate.xx, soil.dtyy[i] = rate.yy, soil.dtxy[i] = rate.xy;
    t = elastic + (2.0 * law.bingham.eta) * e;
  }
  const Sym2 s = cauchy(p, t);
  soil.drho[i] = rates.drho, soil.p[i] = p, soil.gamma_dot[i] = gamma_dot;
  soil.sxx[i] = s.xx, soil.syy[i] = s.yy, soil.sxy[i] = s.xy;
}

template <class Kernel>
RightHandSide::Rates RightHandSide::soil_rates(const Kernel& kernel, const Soil& soil, std::size_t i,
                                               const CellList& soil_cells) const {
  const bool by_mass = k_.numerics.continuity == Continuity::mass;
  const bool diffuse = k_.numerics.density_filter == DensityFilter::delta_sph;
  const Vec2 v_i = soil.velocity(i);
  const double rho_i = soil.rho[i], rho0 = rho0_[static_cast<std::size_t>(soil.material[i])];
  Rates rates{{}, 0.0, std::numeric_limits<double>::infinity()};
  double diffusion = 0.0;
  for_neighbours(soil_cells, soil, soil.position(i), kernel.support2(), [&](std::size_t j, Vec2 r, double r2) {
    const double F = kernel.F(r2), V_j = soil.m[j] / soil.rho[j];
    const Vec2 grad_W = F * r, v_ij = v_i - soil.velocity(j);
    add_velocity_gradient(rates.L, V_j, v_ij, grad_W);
    rates.drho += continuity_term(by_mass ? soil.m[j] : rho_i * V_j, v_ij, grad_W);
    if (diffuse && r2 > 0.0 && soil.material[j] == soil.material[i])
      diffusion += diffusion_term(V_j, soil.rho[j] - rho_i, rho0, k_.g, k_.c_s, r, F);
  });
  if (diffuse) rates.drho += 2.0 * k_.numerics.delta * k_.h * k_.c_s * diffusion;
  return rates;
}

template <class Kernel>
void RightHandSide::add_wall_rates(const Kernel& kernel, const Soil& soil, std::size_t i, const WallParticles& walls,
                                   const CellList& wall_cells, Rates& rates) const {
  const bool only_approaching = k_.walls.contact == WallContact::approaching;
  const Vec2 v_i = soil.velocity(i);
  for_neighbours(wall_cells, walls, soil.position(i), kernel.support2(), [&](std::size_t j, Vec2 r, double r2) {
    const double d_i = distance_to_wall(walls, j, r);
    const double b = mirror_ratio(d_i, walls.depth[j], k_.walls.b_max);
    const Vec2 v_ij = wall_relative_velocity(v_i, walls.normal(j), b, k_.walls.slip);
    if (only_approaching && dot(v_ij, r) >= 0.0) return;
    const Vec2 grad_W = kernel.F(r2) * r;
    add_velocity_gradient(rates.L, walls.volume, v_ij, grad_W);
    rates.drho += continuity_term(soil.rho[i] * walls.volume, v_ij, grad_W);
    rates.wall_distance = std::min(rates.wall_distance, d_i);
  });
}

template <class Kernel>
void RightHandSide::wall_stress(const Kernel& kernel, const Soil& soil, WallParticles& walls, std::size_t w,
                                const CellList& soil_cells) const {
  WallStressSum sum;
  for_neighbours(soil_cells, soil, walls.position(w), kernel.support2(), [&](std::size_t j, Vec2 r, double r2) {
    const Dev t{soil.sxx[j] + soil.p[j], soil.syy[j] + soil.p[j], soil.sxy[j]};
    sum.add(kernel.W(r2), soil.p[j], t, soil.rho[j], rho0_[static_cast<std::size_t>(soil.material[j])], k_.g, r,
            k_.c_s);
  });
  const double inverse = sum.weight > least_weight * kernel.W(0.0) ? 1.0 / sum.weight : 0.0;
  const double p = k_.numerics.tension_cutoff ? without_tension(sum.p * inverse) : sum.p * inverse;
  const double growth = k_.walls.slip == WallSlip::no_slip ? deviator_growth(p, sum.p_soil * inverse) : 1.0;
  Sym2 s = cauchy(p, (inverse * growth) * sum.t);
  if (k_.walls.slip == WallSlip::free_slip) s = mirrored(s, walls.normal(w));
  walls.p[w] = p, walls.compression[w] = sum.compression * inverse;
  walls.sxx[w] = s.xx, walls.syy[w] = s.yy, walls.sxy[w] = s.xy;
}

template <class Kernel>
Vec2 RightHandSide::soil_acceleration(const Kernel& kernel, const Soil& soil, std::size_t i,
                                      const CellList& soil_cells) const {
  const ArtificialViscosity Pi{k_.numerics.alpha, k_.numerics.beta, k_.c_s, k_.h};
  const Vec2 v_i = soil.velocity(i);
  const double rho_i = soil.rho[i];
  const Sym2 s_i = soil.stress(i);
  Vec2 a;
  for_neighbours(soil_cells, soil, soil.position(i), kernel.support2(), [&](std::size_t j, Vec2 r, double r2) {
    const double rho_j = soil.rho[j];
    const double viscous = Pi(dot(v_i - soil.velocity(j), r), r2, 0.5 * (rho_i + rho_j));
    a += momentum_term(soil.m[j], s_i, soil.stress(j), rho_i * rho_j, viscous, kernel.F(r2) * r);
  });
  return a;
}

template <class Kernel>
Vec2 RightHandSide::wall_acceleration(const Kernel& kernel, const Soil& soil, std::size_t i, const WallParticles& walls,
                                      const CellList& wall_cells) const {
  const ArtificialViscosity Pi{k_.numerics.alpha, k_.numerics.beta, k_.c_s, k_.h};
  const bool only_approaching = k_.walls.contact == WallContact::approaching;
  const Vec2 v_i = soil.velocity(i);
  const double rho_i = soil.rho[i];
  const Sym2 s_i = soil.stress(i);
  Vec2 a;
  for_neighbours(wall_cells, walls, soil.position(i), kernel.support2(), [&](std::size_t j, Vec2 r, double r2) {
    const double b = mirror_ratio(distance_to_wall(walls, j, r), walls.depth[j], k_.walls.b_max);
    const double v_dot_r = dot(wall_relative_velocity(v_i, walls.normal(j), b, k_.walls.slip), r);
    if (only_approaching && v_dot_r >= 0.0) return;
    a += momentum_term(rho_i * walls.volume, s_i, walls.stress(j), rho_i * rho_i, Pi(v_dot_r, r2, rho_i),
                       kernel.F(r2) * r);
  });
  return a;
}

template <class Kernel>
void RightHandSide::shepard(const Kernel& kernel, Soil& soil, const WallParticles& walls, const CellList& soil_cells,
                            const CellList& wall_cells) const {
  const double support2 = kernel.support2();
  std::vector<double> filtered(soil.n_active);
#pragma omp parallel for schedule(static, 128)
  for (std::size_t i = 0; i < soil.n_active; ++i) {
    const Vec2 x_i = soil.position(i);
    const auto rho0 = [&](std::size_t j) { return rho0_[static_cast<std::size_t>(soil.material[j])]; };
    ShepardSum sum;
    for_neighbours(soil_cells, soil, x_i, support2, [&](std::size_t j, Vec2, double r2) {
      sum.add(soil.m[j] / soil.rho[j], soil.rho[j] / rho0(j), kernel.W(r2));
    });
    for_neighbours(wall_cells, walls, x_i, support2, [&](std::size_t j, Vec2, double r2) {
      if (walls.compression[j] > 0.0) sum.add(walls.volume, walls.compression[j], kernel.W(r2));
    });
    filtered[i] = rho0(i) * sum.value();
  }
  std::copy(filtered.begin(), filtered.end(), soil.rho.begin());
}

template <class Kernel>
void RightHandSide::evaluate_plain(const Kernel& kernel, Soil& soil, WallParticles& walls, const CellList& soil_cells,
                                   const CellList& wall_cells) const {
#pragma omp parallel
  {
#pragma omp for schedule(static, chunk_size)
    for (std::size_t i = 0; i < soil.n_active; ++i) {
      Rates rates = soil_rates(kernel, soil, i, soil_cells);
      add_wall_rates(kernel, soil, i, walls, wall_cells, rates);
      apply_law(soil, i, rates);
    }
#pragma omp for schedule(static, chunk_size)
    for (std::size_t w = 0; w < walls.size(); ++w) wall_stress(kernel, soil, walls, w, soil_cells);
#pragma omp for schedule(static, chunk_size)
    for (std::size_t i = 0; i < soil.n_active; ++i) {
      const Vec2 a =
          k_.g + soil_acceleration(kernel, soil, i, soil_cells) + wall_acceleration(kernel, soil, i, walls, wall_cells);
      soil.ax[i] = a.x, soil.ay[i] = a.y;
    }
  }
}

void RightHandSide::evaluate(Soil& soil, WallParticles& walls, const CellList& soil_cells, const CellList& wall_cells) {
  if (k_.numerics.kernel == KernelShape::cubic_spline)
    evaluate_plain(CubicSpline{k_.h}, soil, walls, soil_cells, wall_cells);
  else
    evaluate_plain(WendlandC2{k_.h}, soil, walls, soil_cells, wall_cells);
}

void RightHandSide::filter_density(Soil& soil, const WallParticles& walls, const CellList& soil_cells,
                                   const CellList& wall_cells) const {
  if (k_.numerics.kernel == KernelShape::cubic_spline)
    shepard(CubicSpline{k_.h}, soil, walls, soil_cells, wall_cells);
  else
    shepard(WendlandC2{k_.h}, soil, walls, soil_cells, wall_cells);
}

}  // namespace talus

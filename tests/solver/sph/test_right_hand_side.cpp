// The loops against an oracle that knows no cells: every pair, formulas written out once more, in double.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "closeness.hpp"
#include "random_soil.hpp"
#include "sph/right_hand_side.hpp"

namespace talus {
namespace {

using namespace testing_support;

struct Rates {
  std::vector<double> ax, ay, drho, dtxx, dtyy, dtxy, p, sxx, syy, sxy, gamma_dot;
  std::vector<double> wall_p, wall_sxx, wall_syy, wall_sxy, wall_density_ratio;
};

/// Every rate straight from the equations, for every option of the kernel, the constitutive law and the walls.
Rates brute_force(const FlowConstants& k, Soil s, const WallParticles& w) {
  const std::size_t n = s.size(), nw = w.size();
  Rates r;
  for (auto* a : {&r.ax, &r.ay, &r.drho, &r.dtxx, &r.dtyy, &r.dtxy, &r.p, &r.sxx, &r.syy, &r.sxy, &r.gamma_dot})
    a->assign(n, 0.0);
  for (auto* a : {&r.wall_p, &r.wall_sxx, &r.wall_syy, &r.wall_sxy, &r.wall_density_ratio}) a->assign(nw, 0.0);
  const double sigma = 15 / (7 * std::numbers::pi * k.h * k.h);
  const bool wendland = k.numerics.kernel == KernelShape::wendland_c2;
  const double sigma_c2 = 7 / (4 * std::numbers::pi * k.h * k.h);
  const auto W = [&](double d) {
    const double q = d / k.h;
    if (wendland) return q < 2 ? sigma_c2 * std::pow(1 - q / 2, 4) * (2 * q + 1) : 0.0;
    return q < 1 ? sigma * (2.0 / 3 - q * q + q * q * q / 2) : q < 2 ? sigma * std::pow(2 - q, 3) / 6 : 0.0;
  };
  const auto dW = [&](double d) {  // dW/dr
    const double q = d / k.h;
    if (wendland) return q < 2 ? -5 * sigma_c2 / k.h * q * std::pow(1 - q / 2, 3) : 0.0;
    return q < 1 ? sigma / k.h * (-2 * q + 1.5 * q * q) : q < 2 ? -sigma / k.h * 0.5 * (2 - q) * (2 - q) : 0.0;
  };
  const auto slip = [&](std::size_t j) { return k.boundaries[static_cast<std::size_t>(w.boundary[j])].slip; };
  struct WallPair {
    double distance;  ///< of the soil particle to the wall line
    double vx, vy;    ///< v_i minus the virtual velocity of the wall particle
    bool acts;
  };
  const auto wall_pair = [&](std::size_t i, std::size_t j) {
    const double x = s.x[i] - w.x[j], y = s.y[i] - w.y[j];
    const double d_i = x * w.nx[j] + y * w.ny[j] - w.depth[j];
    const double b = std::min(k.walls.b_max, 1 + w.depth[j] / std::max(d_i, 1e-6 * w.depth[j]));
    double vx = b * s.vx[i], vy = b * s.vy[i];
    if (slip(j) == WallSlip::free_slip) {
      const double v_n = s.vx[i] * w.nx[j] + s.vy[i] * w.ny[j];
      vx = b * v_n * w.nx[j];
      vy = b * v_n * w.ny[j];
    }
    const bool approaches = vx * x + vy * y < 0;
    return WallPair{d_i, vx, vy, std::hypot(x, y) < 2 * k.h && (k.walls.contact == WallContact::always || approaches)};
  };
  const auto rho0 = [&](std::size_t i) {
    return s.rho0.empty() ? k.soils[static_cast<std::size_t>(s.material[i])].eos.rho0 : s.rho0[i];
  };
  std::vector<double> e_xx(n), e_yy(n), e_xy(n);
  for (std::size_t i = 0; i < n; ++i) {
    const ConstitutiveParameters& law = k.soils[static_cast<std::size_t>(s.material[i])];
    double Lxx = 0, Lxy = 0, Lyx = 0, Lyy = 0, mass_form = 0, diffusion = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double x = s.x[i] - s.x[j], y = s.y[i] - s.y[j], d = std::hypot(x, y);
      if (i == j) continue;
      const double gx = dW(d) * x / d, gy = dW(d) * y / d, V = s.m[j] / s.rho[j];
      Lxx += V * (s.vx[j] - s.vx[i]) * gx;
      Lxy += V * (s.vx[j] - s.vx[i]) * gy;
      Lyx += V * (s.vy[j] - s.vy[i]) * gx;
      Lyy += V * (s.vy[j] - s.vy[i]) * gy;
      mass_form += s.m[j] * ((s.vx[i] - s.vx[j]) * gx + (s.vy[i] - s.vy[j]) * gy);
      if (s.material[i] == s.material[j]) {
        const double hydrostatic = (k.g.x * -x + k.g.y * -y) / (k.c_s * k.c_s);
        const double q_ji = s.rho[j] / rho0(j) - s.rho[i] / rho0(i);
        diffusion += V * rho0(i) * (q_ji - hydrostatic) * (-x * gx - y * gy) / (d * d);
      }
    }
    double tan_phi = s.tan_phi[i], c = s.c[i];
    for (std::size_t j = 0; j < nw; ++j) {
      const double x = s.x[i] - w.x[j], y = s.y[i] - w.y[j], d = std::hypot(x, y);
      const WallPair pair = wall_pair(i, j);
      if (!pair.acts) continue;
      if (slip(j) == WallSlip::friction && pair.distance < 1.1 * k.h) {
        const WallFriction& of_wall = k.boundaries[static_cast<std::size_t>(w.boundary[j])];
        tan_phi = std::min(tan_phi, of_wall.tan_phi);
        c = std::min(c, of_wall.c);
      }
      const double gx = dW(d) * x / d, gy = dW(d) * y / d;
      Lxx -= w.volume * pair.vx * gx;
      Lxy -= w.volume * pair.vx * gy;
      Lyx -= w.volume * pair.vy * gx;
      Lyy -= w.volume * pair.vy * gy;
      mass_form += s.rho[i] * w.volume * (pair.vx * gx + pair.vy * gy);
    }
    e_xx[i] = Lxx;
    e_yy[i] = Lyy;
    e_xy[i] = (Lxy + Lyx) / 2;
    r.drho[i] = k.numerics.continuity == Continuity::mass ? mass_form : -s.rho[i] * (Lxx + Lyy);
    if (k.numerics.density_filter == DensityFilter::delta_sph)
      r.drho[i] += 2 * k.numerics.delta * k.h * k.c_s * diffusion;
    const double p_full = law.eos.B * (std::pow(s.rho[i] / rho0(i), 7) - 1);
    const double p = k.numerics.tension_cutoff ? std::max(p_full, 0.0) : p_full;
    const double third = (Lxx + Lyy) / 3, exx = Lxx - third, eyy = Lyy - third, ezz = -third, exy = (Lxy + Lyx) / 2;
    const double norm2_e = exx * exx + eyy * eyy + ezz * ezz + 2 * exy * exy;
    const bool printed = k.rheology.shear_rate == ShearRate::paper;
    r.gamma_dot[i] = std::sqrt((printed ? 2.0 / 3 : 2.0) * norm2_e);
    const double tau_y = c + std::max(p, 0.0) * tan_phi;
    double eta = s.eta.empty() ? law.eta : s.eta[i];
    if (const InertialFriction<>& grains = law.mu_i; grains.d > 0 && p > 0) {
      const double I = r.gamma_dot[i] * grains.d / std::sqrt(p / grains.rho_s);
      eta += p * (grains.delta_mu * I + grains.mu_inf * I * I) / (grains.I_0 + I) / r.gamma_dot[i];
    }
    r.p[i] = p;
    if (k.rheology.yield == Yield::regularized) {
      const double eta_y = eta + tau_y / std::max(r.gamma_dot[i], 1e-3);
      r.sxx[i] = -p + 2 * eta_y * exx;
      r.syy[i] = -p + 2 * eta_y * eyy;
      r.sxy[i] = 2 * eta_y * exy;
    } else {
      double txx = s.txx[i], tyy = s.tyy[i], txy = s.txy[i];
      const double size = std::sqrt((txx * txx + tyy * tyy + (txx + tyy) * (txx + tyy) + 2 * txy * txy) / 2);
      const double limit = printed ? std::sqrt(3.0) * tau_y : tau_y;
      if (size > limit) {
        txx *= limit / size;
        tyy *= limit / size;
        txy *= limit / size;
      }
      // Jaumann: omega t - t omega with omega_xy = (Lxy - Lyx)/2 = -omega_yx
      const double omega = (Lxy - Lyx) / 2;
      r.dtxx[i] = 2 * omega * txy + 2 * law.G * exx;
      r.dtyy[i] = -2 * omega * txy + 2 * law.G * eyy;
      r.dtxy[i] = omega * tyy - txx * omega + 2 * law.G * exy;
      r.sxx[i] = -p + txx + 2 * eta * exx;
      r.syy[i] = -p + tyy + 2 * eta * eyy;
      r.sxy[i] = txy + 2 * eta * exy;
    }
  }
  for (std::size_t q = 0; q < nw; ++q) {
    double sum = 0, p = 0, p_soil = 0, txx = 0, tyy = 0, txy = 0, compression = 0, cohesion = 0, tan_phi = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double x = w.x[q] - s.x[j], y = w.y[q] - s.y[j], weight = W(std::hypot(x, y));
      const double g_r = k.g.x * x + k.g.y * y;
      sum += weight;
      p_soil += weight * r.p[j];
      p += weight * (r.p[j] + s.rho[j] * g_r);
      compression += weight * (s.rho[j] / rho0(j) + g_r / (k.c_s * k.c_s));
      txx += weight * (r.sxx[j] + r.p[j]);
      tyy += weight * (r.syy[j] + r.p[j]);
      txy += weight * r.sxy[j];
      cohesion += weight * s.c[j];
      tan_phi += weight * s.tan_phi[j];
    }
    if (sum == 0) continue;
    const double held = std::min(p / sum, 6.0 * std::max(p_soil / sum, 0.0));
    r.wall_p[q] = k.numerics.tension_cutoff ? std::max(held, 0.0) : held;
    r.wall_density_ratio[q] = compression / sum;
    cohesion /= sum;
    tan_phi /= sum;
    const double factor = k.rheology.shear_rate == ShearRate::paper ? std::sqrt(3.0) : 1.0, tzz = -txx - tyy;
    const double size = std::sqrt((txx * txx + tyy * tyy + tzz * tzz) / 2 + txy * txy) / sum, p_mean = p_soil / sum;
    const double ratio = p_soil > 0 ? std::clamp(r.wall_p[q] / p_mean, 0.0, 6.0) : 1.0;
    const double yield_soil = factor * (cohesion + tan_phi * std::max(p_mean, 0.0)),
                 yield_wall = factor * (cohesion + tan_phi * std::max(r.wall_p[q], 0.0));
    double growth = 1;
    if (slip(q) == WallSlip::free_slip)
      growth = 1;
    else if (size > yield_soil)
      growth = (std::min(ratio * yield_soil, yield_wall) + ratio * (size - yield_soil)) / size;
    else if (size > 0)
      growth = std::min(ratio, yield_wall / size);
    double sxx = txx * growth / sum - r.wall_p[q], syy = tyy * growth / sum - r.wall_p[q], sxy = txy * growth / sum;
    if (slip(q) == WallSlip::free_slip) {  // in the axes of the normal and the tangent (-ny, nx), shear reversed
      const double c = w.nx[q], z = w.ny[q];
      const double nn = c * c * sxx + z * z * syy + 2 * c * z * sxy, tt = z * z * sxx + c * c * syy - 2 * c * z * sxy;
      const double nt = -(-c * z * sxx + c * z * syy + (c * c - z * z) * sxy);
      sxx = c * c * nn + z * z * tt - 2 * c * z * nt;
      syy = z * z * nn + c * c * tt + 2 * c * z * nt;
      sxy = c * z * nn - c * z * tt + (c * c - z * z) * nt;
    }
    const WallFriction& of_wall = k.boundaries[static_cast<std::size_t>(w.boundary[q])];
    const double limit =
        factor * (std::min(cohesion, of_wall.c) + std::min(tan_phi, of_wall.tan_phi) * std::max(r.wall_p[q], 0.0));
    if (limit < yield_wall) {  // without pressure, a smaller friction angle makes no weaker wall
      const double nx = w.nx[q], ny = w.ny[q], shear = nx * ny * (syy - sxx) + (nx * nx - ny * ny) * sxy;
      const double back = shear - std::clamp(shear, -limit, limit);
      sxx += 2 * nx * ny * back;
      syy -= 2 * nx * ny * back;
      sxy -= (nx * nx - ny * ny) * back;
    }
    r.wall_sxx[q] = sxx, r.wall_syy[q] = syy, r.wall_sxy[q] = sxy;
  }
  for (std::size_t i = 0; i < n; ++i) {
    r.ax[i] = k.g.x;
    r.ay[i] = k.g.y;
    const bool reconstruct = k.numerics.velocity_jump == VelocityJump::reconstructed;
    const auto viscous = [&](double vr, double x, double y, double rho) {
      const double mu = k.h * vr / (x * x + y * y + 0.01 * k.h * k.h);
      return -mu * (k.numerics.alpha * k.c_s + k.numerics.beta * std::abs(mu)) / rho;
    };
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const double x = s.x[i] - s.x[j], y = s.y[i] - s.y[j], d = std::hypot(x, y), gx = dW(d) * x / d,
                   gy = dW(d) * y / d;
      double vr = (s.vx[i] - s.vx[j]) * x + (s.vy[i] - s.vy[j]) * y;
      if (reconstruct) {
        const double smooth =
            ((e_xx[i] + e_xx[j]) * x * x + (e_yy[i] + e_yy[j]) * y * y) / 2 + (e_xy[i] + e_xy[j]) * x * y;
        const double left2 = std::pow(vr - smooth, 2);
        vr *= std::pow(left2 / (left2 + 4 * smooth * smooth), 2);
      } else {
        vr = std::min(vr, 0.0);
      }
      const double mean = (s.rho[i] + s.rho[j]) / 2, rr = s.rho[i] * s.rho[j];
      const double Pi = viscous(vr, x, y, reconstruct ? rr / mean : mean);
      r.ax[i] += s.m[j] * (((r.sxx[i] + r.sxx[j]) / rr - Pi) * gx + (r.sxy[i] + r.sxy[j]) / rr * gy);
      r.ay[i] += s.m[j] * ((r.sxy[i] + r.sxy[j]) / rr * gx + ((r.syy[i] + r.syy[j]) / rr - Pi) * gy);
    }
    for (std::size_t j = 0; j < nw; ++j) {
      const double x = s.x[i] - w.x[j], y = s.y[i] - w.y[j], d = std::hypot(x, y);
      const WallPair pair = wall_pair(i, j);
      if (!pair.acts) continue;
      const double gx = dW(d) * x / d, gy = dW(d) * y / d, rho = s.rho[i], V = w.volume / rho;
      double arm_x = x, arm_y = y;
      if (reconstruct) {
        const double height = x * w.nx[j] + y * w.ny[j];
        arm_x = height * w.nx[j];
        arm_y = height * w.ny[j];
      }
      const double Pi = viscous(std::min(pair.vx * arm_x + pair.vy * arm_y, 0.0), x, y, rho),
                   viscosity = rho * rho * Pi * dW(d) / d;
      r.ax[i] += V * ((r.sxx[i] + r.wall_sxx[j]) * gx + (r.sxy[i] + r.wall_sxy[j]) * gy - viscosity * arm_x);
      r.ay[i] += V * ((r.sxy[i] + r.wall_sxy[j]) * gx + (r.syy[i] + r.wall_syy[j]) * gy - viscosity * arm_y);
    }
  }
  return r;
}

constexpr WallFriction rough, smoother{WallSlip::friction, 0.1}, frictionless{WallSlip::free_slip};

struct Option {
  const char* name;
  void (*set)(FlowConstants&);
};

class RightHandSideOracle : public testing::TestWithParam<Option> {};

/// @param own  particles have densities and viscosities of their own
void compare_with_oracle(const Option& option, Precision precision, double tolerance, bool own = false) {
  const double dx = 0.1;
  FlowConstants k = constants(dx, {1.3, -9.81}, {{"a", 2000, 0.5, 700, 30}, {"b", 1900, 0.5, 100, 90}});
  k.numerics.beta = 0.4;
  k.numerics.precision = precision;
  option.set(k);
  Soil soil = random_soil(14, 9, dx, 11, 2);
  if (own) vary_properties(soil);
  WallParticles walls = flat_walls(14, dx);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    walls.nx[w] = -0.28;
    walls.ny[w] = 0.96;  // so that x and y differ
    walls.boundary[w] = static_cast<std::int32_t>(w % k.boundaries.size());
  }
  const CellList soil_cells = sorted(soil, 2 * k.h), wall_cells = sorted(walls, 2 * k.h);
  const Rates expected = brute_force(k, soil, walls);
  evaluate(k, soil, walls, soil_cells, wall_cells);
  expect_close(soil.drho, expected.drho, tolerance, "drho");
  expect_close(soil.p, expected.p, tolerance, "p");
  expect_close(soil.gamma_dot, expected.gamma_dot, tolerance, "gamma_dot");
  expect_close(soil.sxx, expected.sxx, tolerance, "sxx");
  expect_close(soil.syy, expected.syy, tolerance, "syy");
  expect_close(soil.sxy, expected.sxy, tolerance, "sxy");
  expect_close(soil.dtxx, expected.dtxx, tolerance, "dtxx");
  expect_close(soil.dtyy, expected.dtyy, tolerance, "dtyy");
  expect_close(soil.dtxy, expected.dtxy, tolerance, "dtxy");
  expect_close(walls.p, expected.wall_p, tolerance, "wall p");
  expect_close(walls.density_ratio, expected.wall_density_ratio, tolerance, "wall density ratio");
  // A smooth wall turns pressure into shear, so that its shear carries the rounding of the pressure.
  const bool smooth =
      std::ranges::any_of(k.boundaries, [](const WallFriction& b) { return b.slip == WallSlip::free_slip; });
  const double turned = smooth ? 10 * tolerance : tolerance;
  expect_close(walls.sxx, expected.wall_sxx, turned, "wall sxx");
  expect_close(walls.syy, expected.wall_syy, turned, "wall syy");
  expect_close(walls.sxy, expected.wall_sxy, turned, "wall sxy");
  expect_close(soil.ax, expected.ax, tolerance, "ax");
  expect_close(soil.ay, expected.ay, tolerance, "ay");
}

TEST_P(RightHandSideOracle, PlainLoopsEqualEveryPairSummed) { compare_with_oracle(GetParam(), Precision::full, 1e-11); }
// Twenty terms of 24-bit arithmetic, with cancellation: 2e-6 of the largest value; seen 3e-7.
TEST_P(RightHandSideOracle, VectorisedLoopsEqualEveryPairSummed) {
  compare_with_oracle(GetParam(), Precision::single, 2e-6);
}

// Densities that differ by tens of per cent, viscosities by a factor of five, in soil of two materials.
TEST_P(RightHandSideOracle, DensityAndViscosityOfEachParticle) {
  compare_with_oracle(GetParam(), Precision::full, 1e-11, true);
  compare_with_oracle(GetParam(), Precision::single, 2e-6, true);
}

INSTANTIATE_TEST_SUITE_P(
    Options, RightHandSideOracle,
    testing::Values(Option{"defaults", [](FlowConstants&) {}},
                    Option{"regularized", [](FlowConstants& k) { k.rheology.yield = Yield::regularized; }},
                    Option{"paper_norm",
                           [](FlowConstants& k) {
                             k.rheology.yield = Yield::regularized;
                             k.rheology.shear_rate = ShearRate::paper;
                           }},
                    Option{"paper_norm_elastic", [](FlowConstants& k) { k.rheology.shear_rate = ShearRate::paper; }},
                    Option{"wendland", [](FlowConstants& k) { k.numerics.kernel = KernelShape::wendland_c2; }},
                    Option{"approaching", [](FlowConstants& k) { k.walls.contact = WallContact::approaching; }},
                    Option{"reconstructed",
                           [](FlowConstants& k) { k.numerics.velocity_jump = VelocityJump::reconstructed; }},
                    Option{"reconstructed_linear_where_approaching",
                           [](FlowConstants& k) {
                             k.numerics.velocity_jump = VelocityJump::reconstructed;
                             k.numerics.beta = 0.0;
                             k.walls.contact = WallContact::approaching;
                             k.boundaries = {frictionless, rough};
                           }},
                    Option{"mass_form", [](FlowConstants& k) { k.numerics.continuity = Continuity::mass; }},
                    Option{"mass_form_of_touching_walls",
                           [](FlowConstants& k) {
                             k.numerics.continuity = Continuity::mass;
                             k.walls.contact = WallContact::approaching;
                             k.numerics.density_filter = DensityFilter::shepard;
                           }},
                    Option{"friction", [](FlowConstants& k) { k.boundaries = {smoother}; }},
                    Option{"cohesion_of_the_wall",
                           [](FlowConstants& k) {
                             k.boundaries = {{WallSlip::friction, 0.1, 40}, {WallSlip::friction, 0.1, 300}, smoother};
                           }},
                    Option{"friction_where_approaching",
                           [](FlowConstants& k) {
                             k.boundaries = {smoother};
                             k.walls.contact = WallContact::approaching;
                             k.rheology.yield = Yield::regularized;
                           }},
                    Option{"free_slip", [](FlowConstants& k) { k.boundaries = {frictionless}; }},
                    Option{"free_slip_where_approaching",
                           [](FlowConstants& k) {
                             k.boundaries = {frictionless};
                             k.walls.contact = WallContact::approaching;
                           }},
                    Option{"walls_of_three_boundaries",
                           [](FlowConstants& k) {
                             k.boundaries = {frictionless, smoother, rough, {WallSlip::friction, 0.3}};
                           }},
                    Option{"regularized_between_two_boundaries",
                           [](FlowConstants& k) {
                             k.boundaries = {frictionless, smoother};
                             k.walls.contact = WallContact::approaching;
                             k.rheology.yield = Yield::regularized;
                           }},
                    Option{"mu_i_of_both_soils",
                           [](FlowConstants& k) {
                             k.soils[0].mu_i = {.delta_mu = 0.3, .I_0 = 0.2, .mu_inf = 0.1, .d = 0.05, .rho_s = 2600};
                             k.soils[1].mu_i = {.delta_mu = 0.2, .I_0 = 0.4, .mu_inf = 0.3, .d = 0.02, .rho_s = 2800};
                           }},
                    Option{"mu_i_of_one_soil_regularized",
                           [](FlowConstants& k) {
                             k.soils[1].mu_i = {.delta_mu = 0.3, .I_0 = 0.2, .mu_inf = 0.1, .d = 0.05, .rho_s = 2600};
                             k.rheology.yield = Yield::regularized;
                             k.numerics.tension_cutoff = false;
                           }},
                    Option{"tension", [](FlowConstants& k) { k.numerics.tension_cutoff = false; }},
                    Option{"no_diffusion", [](FlowConstants& k) { k.numerics.density_filter = DensityFilter::none; }}),
    [](const auto& param) { return std::string(param.param.name); });

/// Soil and its rates by id, without walls.
Soil evaluated(Soil soil, FlowConstants k, Precision precision = Precision::full) {
  k.numerics.precision = precision;
  WallParticles none;
  CellList no_cells;
  no_cells.build({}, {}, 1.0);
  const CellList cells = sorted(soil, 2 * k.h);
  evaluate(k, soil, none, cells, no_cells);
  CellList unused;
  std::vector<std::uint32_t> place(soil.size());
  for (std::uint32_t i = 0; i < soil.size(); ++i) place[static_cast<std::size_t>(soil.id[i])] = i;
  std::vector<double> scratch;
  for_each_real(soil, [&](const char*, auto& a) { permute(a, place, scratch); });
  return soil;
}

TEST(RightHandSide, PairsConserveLinearMomentumExactly) {
  const FlowConstants k = constants(0.1, {0.7, -9.81});
  const Soil s = evaluated(random_soil(15, 12, 0.1, 5), k);
  Vec2 force;
  double mass = 0, size = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    force += s.m[i] * Vec2{s.ax[i], s.ay[i]};
    mass += s.m[i];
    size += s.m[i] * std::hypot(s.ax[i], s.ay[i]);
  }
  EXPECT_NEAR(force.x, mass * 0.7, 1e-13 * size);
  EXPECT_NEAR(force.y, mass * -9.81, 1e-13 * size);
}

TEST(RightHandSide, VectorisedPairsConserveLinearMomentumToRounding) {
  const FlowConstants k = constants(0.1, {0.7, -9.81});
  const Soil s = evaluated(random_soil(15, 12, 0.1, 5), k, Precision::single);
  Vec2 force;
  double mass = 0, size = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    force += s.m[i] * Vec2{s.ax[i], s.ay[i]};
    mass += s.m[i];
    size += s.m[i] * std::hypot(s.ax[i], s.ay[i]);
  }
  EXPECT_NEAR(force.x, mass * 0.7, 1e-7 * size);
  EXPECT_NEAR(force.y, mass * -9.81, 1e-7 * size);
}

TEST(RightHandSide, FixedPointKeepsVectorisedSumsRightFarFromTheOrigin) {
  // The same soil ten kilometres away, beside one stray particle that stretches the box to 400 m.
  const FlowConstants k = constants(0.1);
  Soil near = random_soil(12, 10, 0.1, 17);
  near.x.back() = 400;
  Soil far = near;
  for (double& x : far.x) x += 1e4;
  const Soil a = evaluated(near, k, Precision::full), b = evaluated(far, k, Precision::single);
  double scale = 0;
  for (const double ax : a.ax) scale = std::max(scale, std::abs(ax));
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b.ax[i], a.ax[i], 2e-5 * scale);
}

TEST(RightHandSide, TurnsWithTheProblem) {
  const double a = 0.61, c = std::cos(a), s = std::sin(a);
  const auto turn = [&](double& x, double& y) {
    const double x0 = x;
    x = c * x0 - s * y;
    y = s * x0 + c * y;
  };
  FlowConstants k = constants(0.1, {0.7, -9.81});
  const Soil original = random_soil(13, 11, 0.1, 23);
  Soil turned = original;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    turn(turned.x[i], turned.y[i]);
    turn(turned.vx[i], turned.vy[i]);
    const double xx = original.txx[i], yy = original.tyy[i], xy = original.txy[i];
    turned.txx[i] = c * c * xx + s * s * yy - 2 * s * c * xy;
    turned.tyy[i] = s * s * xx + c * c * yy + 2 * s * c * xy;
    turned.txy[i] = s * c * (xx - yy) + (c * c - s * s) * xy;
  }
  Soil before = evaluated(original, k);
  turn(k.g.x, k.g.y);
  const Soil after = evaluated(turned, k);
  for (std::size_t i = 0; i < before.size(); ++i) {
    turn(before.ax[i], before.ay[i]);
    ASSERT_NEAR(after.ax[i], before.ax[i], 1e-7);  // of accelerations of 1e4 m/s2
    ASSERT_NEAR(after.ay[i], before.ay[i], 1e-7);
    ASSERT_NEAR(after.drho[i], before.drho[i], 1e-7);
  }
}

TEST(RightHandSide, MirrorsWithTheProblem) {
  const FlowConstants k = constants(0.1);
  const Soil original = random_soil(13, 11, 0.1, 29);
  Soil mirrored_soil = original;
  for (std::size_t i = 0; i < original.size(); ++i) {
    mirrored_soil.x[i] *= -1;
    mirrored_soil.vx[i] *= -1;
    mirrored_soil.txy[i] *= -1;
  }
  const Soil before = evaluated(original, k), after = evaluated(mirrored_soil, k);
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_NEAR(after.ax[i], -before.ax[i], 1e-7);
    ASSERT_NEAR(after.ay[i], before.ay[i], 1e-7);
    ASSERT_NEAR(after.dtxy[i], -before.dtxy[i], 1e-3);  // of rates of 1e7 Pa/s
  }
}

TEST(RightHandSide, UniformMotionFeelsNothingButGravity) {
  FlowConstants k = constants(0.1, {0.0, -9.81}, {{"a", 2000, 0.0, 0, 5}});
  Soil soil = random_soil(15, 15, 0.1, 31);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    soil.vx[i] = 3;
    soil.vy[i] = -2;
    soil.rho[i] = 2000;
    soil.tan_phi[i] = 0;
    soil.txx[i] = soil.tyy[i] = soil.txy[i] = 0;
  }
  k.numerics.density_filter = DensityFilter::none;
  const Soil s = evaluated(soil, k);
  for (std::size_t i = 0; i < s.size(); ++i) {
    ASSERT_NEAR(s.drho[i], 0.0, 1e-9);
    ASSERT_NEAR(s.ax[i], 0.0, 1e-9);
    ASSERT_NEAR(s.ay[i], -9.81, 1e-9);
  }
}

}  // namespace
}  // namespace talus

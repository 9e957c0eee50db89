// The powers of one evaluation: their sum against the rates, for any positions; each term against a closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "integrate/plain_flow.hpp"
#include "random_soil.hpp"
#include "sph/energy-inl.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// What the rates of an evaluation do to the energy of the soil, and the powers that it measured.
struct Balance {
  double kinetic = 0.0, gravity = 0.0, compression = 0.0;  ///< [W/m]
  Powers powers;
  double scale = 0.0;  ///< sum of the absolute powers of all particles

  double taken() const {
    return powers.deviator + powers.viscosity + powers.artificial_viscosity + powers.density_diffusion +
           powers.boundaries;
  }
};

struct Evaluated {
  Soil soil;
  WallParticles walls;
  ParticlePowers<double> powers;

  Evaluated(const FlowConstants& k, Soil s, WallParticles w) : soil(std::move(s)), walls(std::move(w)) {
    const CellList soil_cells = sorted(soil, 2 * k.h), wall_cells = sorted(walls, 2 * k.h);
    evaluate_plain(k, soil, walls, {soil_cells, wall_cells}, &powers);
  }

  Balance balance(const FlowConstants& k) const {
    Balance b;
    for (std::size_t i = 0; i < soil.n_active; ++i) {
      const double of_force = soil.m[i] * dot(soil.velocity(i), {soil.ax[i], soil.ay[i]});
      b.kinetic += of_force;
      b.gravity += soil.m[i] * dot(soil.velocity(i), k.g);
      b.compression += soil.m[i] * soil.p[i] / (soil.rho[i] * soil.rho[i]) * soil.drho[i];
      b.scale += std::abs(of_force);
    }
    b.powers = powers.total(soil.n_active);
    return b;
  }
};

/// Stresses of other sizes, compressed soil and soil in tension, walls on a slope.
FlowConstants varied_constants() {
  FlowConstants k = constants(0.1, {1.3, -9.81}, {{"a", 2000, 0.5, 700, 30}, {"b", 1900, 0.5, 100, 90}});
  k.numerics.beta = 1.5;
  k.numerics.delta = 0.4;
  return k;
}
WallParticles sloping_walls(int nx, double dx) {
  WallParticles walls = flat_walls(nx, dx);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    walls.nx[w] = -0.28;
    walls.ny[w] = 0.96;
  }
  return walls;
}

TEST(Powers, TheBalanceClosesForAnyPositionsAndEveryOption) {
  for (const auto slip : {WallSlip::no_slip, WallSlip::friction, WallSlip::free_slip})
    for (const auto contact : {WallContact::always, WallContact::approaching})
      for (const auto continuity : {Continuity::volume, Continuity::mass})
        for (const auto filter : {DensityFilter::delta_sph, DensityFilter::none})
          for (const auto yield : {Yield::elastic, Yield::regularized})
            for (const auto kernel : {KernelShape::cubic_spline, KernelShape::wendland_c2})
              for (const bool cut : {true, false})
                for (const auto jump : {VelocityJump::reconstructed, VelocityJump::whole}) {
                  FlowConstants k = varied_constants();
                  k.numerics.velocity_jump = jump;
                  k.boundaries = {{slip, slip == WallSlip::friction ? 0.1 : 1e9}};
                  k.walls.contact = contact;
                  k.numerics.continuity = continuity;
                  k.numerics.density_filter = filter;
                  k.numerics.kernel = kernel;
                  k.numerics.tension_cutoff = cut;
                  k.rheology.yield = yield;
                  Soil soil = random_soil(20, 8, k.dx, 47, 2);
                  if (cut) soil.rho[50] = 300;  // so loose that its volume is bounded
                  if (contact == WallContact::always) vary_properties(soil);
                  const Balance b = Evaluated(k, std::move(soil), sloping_walls(20, k.dx)).balance(k);
                  EXPECT_NEAR(b.kinetic + b.compression - b.gravity + b.taken(), 0.0, 1e-12 * b.scale);
                  for (const double term : {b.powers.deviator, b.powers.viscosity, b.powers.artificial_viscosity,
                                            b.powers.boundaries, b.compression})
                    EXPECT_GT(std::abs(term), 1e-5 * b.scale) << "each term has its weight";
                  if (filter == DensityFilter::delta_sph || continuity == Continuity::mass) {
                    EXPECT_GT(std::abs(b.powers.density_diffusion), 1e-5 * b.scale);
                  } else {
                    EXPECT_EQ(b.powers.density_diffusion, 0.0);
                  }
                }
}

TEST(Powers, ViscosityAndFrictionOfTheRegularisedLaw) {
  FlowConstants k = constants(0.1);
  k.rheology.yield = Yield::regularized;
  const Evaluated at(k, random_soil(9, 8, k.dx, 5), flat_walls(9, k.dx));
  for (std::size_t i = 0; i < at.soil.size(); ++i) {
    const double V = at.soil.m[i] / at.soil.rho[i], gamma_dot = at.soil.gamma_dot[i];
    const double tau_y = at.soil.c[i] + at.soil.p[i] * at.soil.tan_phi[i], eta = 30;
    ASSERT_GT(gamma_dot, k.rheology.gamma_dot_min);
    EXPECT_NEAR(at.powers.viscosity[i], V * eta * gamma_dot * gamma_dot, 1e-10 * at.powers.viscosity[i]);
    EXPECT_NEAR(at.powers.deviator[i], V * tau_y * gamma_dot, 1e-10 * at.powers.deviator[i]);
    EXPECT_GT(at.powers.deviator[i], 0.0);
  }
}

TEST(Powers, WhatMuOfITakesBeyondTheYieldStressIsViscous) {
  FlowConstants k = constants(0.1);
  k.soils[0].eta = 0;
  k.soils[0].mu_i = {.delta_mu = 0.3, .I_0 = 0.2, .mu_inf = 0.1, .d = 0.05, .rho_s = 2600};
  const Evaluated at(k, random_soil(9, 8, k.dx, 5), flat_walls(9, k.dx));
  std::size_t pressed = 0;
  for (std::size_t i = 0; i < at.soil.size(); ++i) {
    const double V = at.soil.m[i] / at.soil.rho[i], gamma_dot = at.soil.gamma_dot[i], p = at.soil.p[i];
    const double I = p > 0 ? gamma_dot * 0.05 / std::sqrt(p / 2600) : 0;
    const double share = V * p * (0.3 * I + 0.1 * I * I) / (0.2 + I) * gamma_dot;
    EXPECT_NEAR(at.powers.viscosity[i], share, 1e-10 * share);
    pressed += p > 0;
  }
  EXPECT_GT(pressed, at.soil.size() / 3);
}

TEST(Powers, OfAnElasticStressInSimpleShear) {
  // t = (., ., t_xy) in v_x = gamma y: V t_xy gamma, whatever txx and tyy; viscosity V eta gamma^2.
  using namespace HWY_NAMESPACE;
  const double V = 0.3, p = 900, gamma = 4, eta = 25, txx = 70, tyy = -20, txy = 55;
  const Gradient<double> L{0, gamma, 0, 0};
  const Deviator<double> e = deviatoric_strain_rate(L);
  const Deviator<double> t{txx, tyy, txy + eta * gamma};
  const StressPowers<double> powers = stress_powers(V, p, t, e, eta, trace(L), 0.0, 0.0, 0.01);
  EXPECT_DOUBLE_EQ(powers.deviator, V * txy * gamma);
  EXPECT_DOUBLE_EQ(powers.viscosity, V * eta * gamma * gamma);
  EXPECT_EQ(powers.density_diffusion, 0.0);
}

/// Two particles of the same mass at a distance of h on the x axis.
Soil two_particles(const FlowConstants& k) {
  Soil soil = random_soil(2, 1, k.dx, 3);
  soil.x = {0, k.h};
  soil.y = {0, 0};
  soil.vx = {0, 0};
  soil.vy = {0, 0};
  soil.m = {18, 18};
  soil.txx = soil.tyy = soil.txy = {0, 0};
  return soil;
}

TEST(Powers, ArtificialViscosityOfTwoParticlesThatApproach) {
  FlowConstants k = constants(0.1);
  k.numerics.kernel = KernelShape::wendland_c2;
  k.numerics.alpha = 0.3;
  k.numerics.beta = 0.7;
  k.numerics.velocity_jump = VelocityJump::whole;
  Soil soil = two_particles(k);
  const double rho_1 = 1900, rho_2 = 2300, approach = 2.5;
  soil.rho = {rho_1, rho_2};
  soil.vx = {1.5, 1.5 - approach};
  const Balance b = Evaluated(k, soil, {}).balance(k);
  const double mu = -k.h * approach * k.h / (1.01 * k.h * k.h);
  const double Pi = (-0.3 * k.c_s * mu + 0.7 * mu * mu) / (0.5 * (rho_1 + rho_2));
  const double F = -7 / (4 * std::numbers::pi * std::pow(k.h, 4)) * 5 * std::pow(0.5, 3);  // at r = h
  EXPECT_NEAR(b.powers.artificial_viscosity, 18 * 18 * Pi * F * -approach * k.h, 1e-10 * b.scale);
  EXPECT_GT(b.powers.artificial_viscosity, 0.0);
}

/// Power of the artificial viscosity on a lattice whose velocity is linear in the position, and noise.
double artificial_power(VelocityJump jump, Gradient<double> L, double noise) {
  FlowConstants k = constants(0.1, {0, 0});
  k.numerics.kernel = KernelShape::wendland_c2;
  k.numerics.velocity_jump = jump;
  k.h = 1.5 * k.dx;
  Soil soil = random_soil(16, 16, k.dx, 3);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    const double column = std::round(soil.x[i] / k.dx), row = std::round(soil.y[i] / k.dx);
    soil.x[i] = column * k.dx;
    soil.y[i] = row * k.dx;
    soil.m[i] = soil.rho[i] * k.dx * k.dx;
    soil.vx[i] = L.xx * soil.x[i] + L.xy * soil.y[i] + noise * soil.vx[i];
    soil.vy[i] = L.yx * soil.x[i] + L.yy * soil.y[i] + noise * soil.vy[i];
  }
  const Evaluated at(k, std::move(soil), {});
  double inside = 0.0;  // away from the rim, where the velocity gradient lacks neighbours
  for (std::size_t i = 0; i < at.soil.size(); ++i)
    if (std::abs(at.soil.x[i] - 0.75) < 0.3 && std::abs(at.soil.y[i] - 0.75) < 0.3)
      inside += at.powers.artificial_viscosity[i];
  return inside;
}

TEST(Powers, ReconstructionLeavesSmoothDeformationAloneAndDampsNoise) {
  using enum VelocityJump;
  for (const Gradient<double> L : {Gradient<double>{0, 3, 0, 0}, {0, 0, -2, 0}, {-1, 0, 0, 1}, {-2, 1, 0.5, -1}}) {
    const double monaghan = artificial_power(whole, L, 0.0), left = artificial_power(reconstructed, L, 0.0);
    EXPECT_GT(monaghan, 0.0);
    EXPECT_GE(left, 0.0);
    EXPECT_LT(left, 1e-4 * monaghan) << "but for the error of the velocity gradient on a lattice";
  }
  const double approaching = artificial_power(whole, {0, 0, 0, 0}, 1.0);  // half of all pairs
  EXPECT_GT(artificial_power(reconstructed, {0, 0, 0, 0}, 1.0), 0.5 * approaching);
  EXPECT_LT(artificial_power(reconstructed, {0, 0, 0, 0}, 1.0), 2.0 * approaching);
}

TEST(Powers, ASymmetricJumpIsDampedWhicheverSignItHas) {
  using enum VelocityJump;
  const auto of_pair = [](VelocityJump jump, double towards) {
    FlowConstants k = constants(0.1, {0, 0});
    k.numerics.velocity_jump = jump;
    k.numerics.beta = 1.0;
    Soil two = random_soil(2, 1, k.dx, 1);
    two.x = {0.0, 0.1};
    two.y = {0.0, 0.0};
    two.vx = {towards, -towards};
    two.vy = {0.0, 0.0};
    two.rho[1] = two.rho[0];
    return Evaluated(k, std::move(two), {}).powers.artificial_viscosity[0];
  };
  const double near = of_pair(reconstructed, 1.0);
  EXPECT_GT(near, 0.0);
  EXPECT_NEAR(of_pair(reconstructed, -1.0), near, 1e-9 * near);
  EXPECT_LE(near, of_pair(whole, 1.0));
  EXPECT_EQ(of_pair(whole, -1.0), 0.0) << "Monaghan's term leaves what separates";
}

TEST(Powers, OnlyTheVelocityAcrossAWallIsDampedWithReconstruction) {
  FlowConstants k = constants(0.1, {0, 0});
  const auto power = [&](VelocityJump jump, Vec2 v) {
    k.numerics.velocity_jump = jump;
    Soil one = random_soil(1, 1, k.dx, 1);
    one.x = {0.0};
    one.y = {0.0};
    one.vx = {v.x};
    one.vy = {v.y};
    return Evaluated(k, std::move(one), flat_walls(1, k.dx)).powers.artificial_viscosity[0];
  };
  EXPECT_GT(power(VelocityJump::whole, {1, 0}), 0.0);
  EXPECT_EQ(power(VelocityJump::reconstructed, {1, 0}), 0.0) << "along";
  EXPECT_EQ(power(VelocityJump::reconstructed, {0, 1}), 0.0) << "away";
  const double across = power(VelocityJump::reconstructed, {0, -1});
  EXPECT_NEAR(across, power(VelocityJump::whole, {0, -1}), 0.5 * across);
  EXPECT_NEAR(power(VelocityJump::reconstructed, {7, -1}), across, 1e-12 * across) << "whatever the speed along";
}

TEST(Powers, DiffusionBetweenTwoDensitiesAtRest) {
  FlowConstants k = constants(0.1, {0, 0});
  Soil soil = two_particles(k);
  soil.rho = {2010, 2030};
  const Evaluated at(k, soil, {});
  double taken = 0.0;
  for (std::size_t i = 0; i < 2; ++i)  // nothing moves: only the diffusion changes the densities
    taken -= at.soil.m[i] * at.soil.p[i] / (at.soil.rho[i] * at.soil.rho[i]) * at.soil.drho[i];
  EXPECT_GT(taken, 0.0) << "densities that even out lose energy";
  EXPECT_NEAR(at.balance(k).powers.density_diffusion, taken, 1e-12 * taken);
  EXPECT_EQ(at.balance(k).taken(), at.balance(k).powers.density_diffusion);
}

TEST(Powers, BoundariesTakeWhatTheirForceDoes) {
  // One particle along a smooth wall: nothing is deformed, and the force of the wall works on the particle's velocity.
  FlowConstants k = constants(0.1, {0, 0});
  k.boundaries = {{WallSlip::free_slip, 1e9}};
  Soil soil = random_soil(1, 1, k.dx, 3);
  soil.x = {0.03};
  soil.y = {0.4 * k.dx};
  soil.rho = {2050};
  soil.vx = {3};
  soil.vy = {0};
  const Evaluated at(k, soil, flat_walls(2, k.dx));
  const Balance b = at.balance(k);
  ASSERT_GT(b.scale, 1.0);
  EXPECT_NEAR(b.powers.boundaries, -b.kinetic, 1e-12 * b.scale);
  EXPECT_EQ(b.powers.viscosity, 0.0);
  EXPECT_EQ(b.powers.artificial_viscosity, 0.0);
}

TEST(Powers, AreTheSameInBothBackEnds) {
  for (const auto integrator : {Integrator::rk2, Integrator::leapfrog}) {
    FlowConstants k = varied_constants();
    k.numerics.integrator = integrator;
    const Soil soil = random_soil(20, 8, k.dx, 47, 2);
    const double dt = 0.05 * k.h / k.c_s;
    const auto powers_of = [&](auto&& make) {
      Soil here = soil;
      WallParticles walls = sloping_walls(20, k.dx);
      const CellList soil_cells = sorted(here, 2.5 * k.h), wall_cells = sorted(walls, 2.5 * k.h);
      const auto flow = make(here);
      flow->rebuild_neighbour_lists(here, walls, {soil_cells, wall_cells}, 0.0, 0.1 * k.h);
      Powers powers;
      flow->step(here, walls, {soil_cells, wall_cells}, dt, &powers);
      return powers;
    };
    const Powers plain = powers_of([&](Soil& s) { return std::make_unique<PlainFlow>(k, s); });
    const Powers vectorised = powers_of([&](Soil& s) { return std::make_unique<VectorisedFlow>(k, s); });
    for (const auto term : {&Powers::deviator, &Powers::viscosity, &Powers::artificial_viscosity,
                            &Powers::density_diffusion, &Powers::boundaries}) {
      EXPECT_NEAR(vectorised.*term, plain.*term, 2e-5 * std::abs(plain.deviator) + 2e-5 * std::abs(plain.*term));
      EXPECT_GT(std::abs(plain.*term), 1e-3 * std::abs(plain.deviator));
    }
  }
}

}  // namespace
}  // namespace talus

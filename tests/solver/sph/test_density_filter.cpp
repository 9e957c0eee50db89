#include <gtest/gtest.h>

#include "random_soil.hpp"
#include "sph/continuity-inl.hpp"

namespace talus {
namespace {

using namespace testing_support;

using namespace HWY_NAMESPACE;

TEST(DensityDiffusion, LeavesAHydrostaticProfileAlone) {
  const double rho0 = 1900, c_s = 60;
  const Vector<double> g{0.4, -9.81}, g_per_c2{g.x / (c_s * c_s), g.y / (c_s * c_s)};
  const Vector<double> x_i{3.03, 2.11}, x_j{3.0, 2.0};  // i is above j
  const double rho_i = 1950, rho_j = rho_i + rho0 * dot(g, x_j - x_i) / (c_s * c_s);
  EXPECT_GT(rho_j, rho_i) << "the lower one is denser";
  const auto q = [&](double rho, Vector<double> x) { return dynamic_density(rho / rho0 - 1, g_per_c2, x); };
  EXPECT_NEAR(q(rho_j, x_j), q(rho_i, x_i), 1e-15);
}

TEST(DensityDiffusion, FlowsFromDenseToLight) { EXPECT_GT(add_diffusion(0.0, 0.01 * 7.0, 5.0), 0.0); }

TEST(DensityDiffusion, ConservesMassForEqualVolumes) {
  FlowConstants k = constants(0.1);
  Soil soil = random_soil(12, 12, 0.1, 41);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    soil.m[i] = soil.rho[i] * 0.01;
    soil.vx[i] = soil.vy[i] = 0;
  }
  WallParticles none;
  CellList no_cells;
  no_cells.build({}, {}, 1.0);
  const CellList cells = sorted(soil, 2 * k.h);
  evaluate(k, soil, none, cells, no_cells);
  double sum = 0, size = 0;
  for (const double d : soil.drho) {
    sum += d;
    size += std::abs(d);
  }
  EXPECT_GT(size, 0.0);
  EXPECT_NEAR(sum, 0.0, 1e-12 * size);
}

TEST(ShepardFilter, KeepsAUniformDensityAndSmoothsARandomOne) {
  const FlowConstants k = constants(0.1);
  WallParticles none;
  CellList no_cells;
  no_cells.build({}, {}, 1.0);
  Soil soil = random_soil(12, 12, 0.1, 43);
  const CellList cells = sorted(soil, 2 * k.h);
  const auto spread = [&] {  // standard deviation
    double sum = 0, sum2 = 0;
    for (const double r : soil.rho) {
      sum += r - 2000;
      sum2 += (r - 2000) * (r - 2000);
    }
    const auto n = static_cast<double>(soil.size());
    return std::sqrt(sum2 / n - sum * sum / (n * n));
  };
  const double before = spread();
  filter_density(k, soil, none, {cells, no_cells});
  EXPECT_LT(spread(), 0.6 * before);
  soil.rho.assign(soil.size(), 2050.0);
  filter_density(k, soil, none, {cells, no_cells});
  for (const double r : soil.rho) ASSERT_NEAR(r, 2050.0, 1e-9);
}

TEST(ShepardFilter, DoesNotMixTheDensitiesOfTwoLayers) {
  const FlowConstants k = constants(0.1, {0, -9.81}, {{"a", 2000, 0, 0, 0}, {"b", 1500, 0, 0, 0}});
  WallParticles none;
  CellList no_cells;
  no_cells.build({}, {}, 1.0);
  Soil soil = random_soil(12, 12, 0.1, 47, 2);
  const CellList cells = sorted(soil, 2 * k.h);
  for (std::size_t i = 0; i < soil.size(); ++i) soil.rho[i] = soil.material[i] == 0 ? 2000 * 1.01 : 1500 * 1.01;
  filter_density(k, soil, none, {cells, no_cells});
  for (std::size_t i = 0; i < soil.size(); ++i)
    ASSERT_NEAR(soil.rho[i], soil.material[i] == 0 ? 2000 * 1.01 : 1500 * 1.01, 1e-9);
}

}  // namespace
}  // namespace talus

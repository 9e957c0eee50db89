// The vectorised loops where the plain ones have no counterpart: lists that last, walls of every kind, threads' shares.

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <utility>

#include "closeness.hpp"
#include "integrate/vectorised_flow.hpp"
#include "random_soil.hpp"

namespace talus {
namespace {

using namespace testing_support;

/// Moves every particle by exactly `way` in some direction.
void displace(Soil& soil, double way, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> angle(0.0, 2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    const double a = angle(engine);
    soil.x[i] += way * std::cos(a);
    soil.y[i] += way * std::sin(a);
  }
}

TEST(VectorisedFlow, ListsReachAsFarAsParticlesMayHaveGone) {
  // Large ways, so that a list that is too short by one of them misses neighbours of weight.
  FlowConstants k = constants(0.1);
  const double moved = 0.6 * k.h, way = 0.4 * k.h;
  Soil soil = random_soil(40, 12, k.dx, 41);
  for (double& y : soil.y) y += moved + way;  // nothing goes through the wall
  WallParticles walls = flat_walls(40, k.dx);
  const CellList soil_cells = sorted(soil, 2 * k.h + moved + way), wall_cells = sorted(walls, 2 * k.h);
  displace(soil, moved, 1);
  VectorisedFlow flow(k, soil);
  flow.rebuild_neighbour_lists(soil, walls, {soil_cells, wall_cells}, moved, way);
  displace(soil, way, 2);
  flow.state_changed();
  Soil plain = soil;
  WallParticles plain_walls = walls;
  evaluate_plain(k, plain, plain_walls, {soil_cells, wall_cells});
  flow.evaluate(soil, walls, 0.0, true);
  flow.read_evaluation(soil, soil);
  expect_close(soil.drho, plain.drho, 2e-6, "drho");
  expect_close(soil.ax, plain.ax, 2e-6, "ax");
  expect_close(walls.p, plain_walls.p, 2e-6, "wall p");
}

TEST(VectorisedFlow, EqualsThePlainLoopsAtWallsOfEveryKind) {
  for (const auto slip : {WallSlip::no_slip, WallSlip::friction, WallSlip::free_slip})
    for (const auto contact : {WallContact::always, WallContact::approaching})
      for (const auto kernel : {KernelShape::cubic_spline, KernelShape::wendland_c2}) {
        FlowConstants k = constants(0.1, {1.3, -9.81}, {{"a", 2000, 0.5, 700, 30}, {"b", 1900, 0.5, 100, 90}});
        k.boundaries = {{slip, slip == WallSlip::friction ? 0.1 : 1e9}};
        k.walls.contact = contact;
        k.numerics.kernel = kernel;
        Soil soil = random_soil(30, 8, k.dx, 47, 2);
        WallParticles walls = flat_walls(30, k.dx);
        for (std::size_t w = 0; w < walls.size(); ++w) {  // sloping
          walls.nx[w] = -0.28;
          walls.ny[w] = 0.96;
        }
        const CellList soil_cells = sorted(soil, 2 * k.h), wall_cells = sorted(walls, 2 * k.h);
        Soil plain = soil;
        WallParticles plain_walls = walls;
        evaluate_plain(k, plain, plain_walls, {soil_cells, wall_cells});
        k.numerics.precision = Precision::single;
        evaluate(k, soil, walls, soil_cells, wall_cells);
        for_each_rate(plain, [&](const std::string& name, const auto& expected) {
          for_each_rate(soil, [&](const std::string& other, const auto& actual) {
            if (name == other) expect_close(actual, expected, 3e-6, name.c_str());
          });
        });
        for_each_wall_real(plain_walls, [&](const std::string& name, const auto& expected) {
          for_each_wall_real(walls, [&](const std::string& other, const auto& actual) {
            if (name == other)
              expect_close(actual, expected, 2e-5, name.c_str());  // a smooth wall turns pressure into shear
          });
        });
      }
}

TEST(VectorisedFlow, AnyNumberOfThreadsGivesTheSameBits) {
  FlowConstants k = constants(0.1);
  k.numerics.precision = Precision::single;
  const int usual = omp_get_max_threads();
  for (const auto& [columns, rows] : {std::pair{61, 23}, {7, 3}}) {  // many clusters, and fewer than threads
    Soil soil = random_soil(columns, rows, k.dx, 53);
    WallParticles walls = flat_walls(columns, k.dx);
    const CellList soil_cells = sorted(soil, 2 * k.h), wall_cells = sorted(walls, 2 * k.h);
    Soil alone;
    for (const int threads : {1, 2, 3, 5, 7}) {
      Soil here = soil;
      WallParticles walls_here = walls;
      omp_set_num_threads(threads);
      evaluate(k, here, walls_here, soil_cells, wall_cells);
      omp_set_num_threads(usual);
      if (threads == 1) alone = here;
      EXPECT_EQ(here.ax, alone.ax) << threads;
      EXPECT_EQ(here.ay, alone.ay) << threads;
      EXPECT_EQ(here.drho, alone.drho) << threads;
      EXPECT_EQ(here.txx, alone.txx) << threads;
    }
    EXPECT_TRUE(std::ranges::none_of(alone.ay, [](double a) { return a == 0.0; }));
  }
}

TEST(VectorisedFlow, AWallThatSeesNextToNothingStaysFinite) {
  // A soil particle within rounding of 2h from the wall particle below it; another one far off changes the fixed
  // point's quantum, so that some of the many kernel values are tiny: none may give infinity.
  FlowConstants k = constants(0.1);
  k.numerics.precision = Precision::single;
  k.numerics.kernel = KernelShape::wendland_c2;
  for (int m = 0; m < 3000; ++m)
    for (int n = -2; n <= 2; ++n) {
      Soil soil = random_soil(2, 1, k.dx, 5);
      soil.x = {0.0, 3.0 + 1e-3 * m};
      soil.y = {2 * k.h * (1 + 6e-8 * n) - k.dx, 1.0};
      WallParticles walls = flat_walls(1, k.dx);
      const CellList soil_cells = sorted(soil, 2 * k.h), wall_cells = sorted(walls, 2 * k.h);
      evaluate(k, soil, walls, soil_cells, wall_cells);
      for (const double p : walls.p) ASSERT_TRUE(std::isfinite(p)) << "extent " << m << ", place " << n;
    }
}

TEST(VectorisedFlow, FollowsParticlesThatChangePlaces) {
  FlowConstants k = constants(0.1);
  Soil soil = random_soil(15, 12, k.dx, 43);
  WallParticles none;
  CellList no_cells;
  no_cells.build({}, {}, 1.0);
  const CellList cells = sorted(soil, 2 * k.h);
  VectorisedFlow flow(k, soil);
  flow.rebuild_neighbour_lists(soil, none, {cells, no_cells}, 0.0, 0.0);
  flow.evaluate(soil, none, 0.0, true);
  Soil before, after;
  flow.read_evaluation(soil, before);
  flow.swap_rates(soil, 3, 100);
  flow.read_evaluation(soil, after);
  const auto expect_moved = [&](const char* name, const auto& array) {
    for_each_real(after, [&](const std::string& other, const auto& moved) {
      if (other != name) return;
      EXPECT_NE(array[3], array[100]) << name;
      EXPECT_EQ(moved[3], array[100]) << name;
      EXPECT_EQ(moved[100], array[3]) << name;
      EXPECT_EQ(moved[4], array[4]) << name;
    });
  };
  for_each_rate(before, expect_moved);
  for_each_derived(before, expect_moved);
  // Rates follow a new order as well; the derived values are rewritten before they are read.
  std::vector<std::uint32_t> order(soil.size());
  std::iota(order.rbegin(), order.rend(), 0u);
  std::vector<double> scratch;
  flow.permute_rates(soil, order, scratch);
  Soil reversed;
  flow.read_evaluation(soil, reversed);
  EXPECT_EQ(reversed.ay[0], after.ay.back());
  EXPECT_EQ(reversed.dtxy[5], after.dtxy[after.dtxy.size() - 6]);
}

}  // namespace
}  // namespace talus

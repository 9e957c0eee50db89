// The load of the soil on its walls is what the soil's momentum loses.

#include <gtest/gtest.h>
#include <omp.h>

#include <memory>

#include "integrate/plain_flow.hpp"
#include "integrate/vectorised_flow.hpp"
#include "random_soil.hpp"

namespace talus {
namespace {

using namespace testing_support;

constexpr double dx = 0.1, dt = 1e-4;
const Vec2 about{0.3, -0.2};

/// What one step of a random soil over a wall of two boundaries changes.
struct Balance {
  Vec2 gained = {};             ///< momentum of the soil over the step's length [N/m]
  Vec2 weight = {};             ///< [N/m]
  std::vector<WallLoad> loads;  ///< of the boundaries 0 and 1
};

Balance balance_of_a_step(bool vectorised, Integrator integrator, VelocityJump jump, double beta = 0.3) {
  FlowConstants k = constants(dx, {1.5, -9.81}, {{"a", 2000, 0.5, 700, 30}, {"b", 1900, 0.3, 100, 90}});
  k.numerics.integrator = integrator;
  k.numerics.velocity_jump = jump;
  k.numerics.beta = beta;
  k.boundaries.emplace_back();
  Soil soil = random_soil(40, 9, dx, 11, 2);
  WallParticles walls = flat_walls(40, dx);
  for (std::size_t w = 0; w < walls.size(); ++w) walls.boundary[w] = walls.x[w] > 1.7 ? 1 : 0;
  ParticleCells cells;
  cells.soil = sorted(soil, 3 * k.h);
  cells.walls = sorted(walls, 3 * k.h);
  const std::unique_ptr<Flow> flow = vectorised ? std::unique_ptr<Flow>(std::make_unique<VectorisedFlow>(k, soil))
                                                : std::make_unique<PlainFlow>(k, soil);
  flow->observe_loads({{0, about}, {1, about}});
  flow->rebuild_neighbour_lists(soil, walls, cells, 0.0, 0.1 * k.h);
  const Soil before = soil;
  flow->step(soil, walls, cells, dt);
  Balance balance{.loads = flow->loads()};
  for (std::size_t i = 0; i < soil.size(); ++i) {
    balance.gained += (soil.m[i] / dt) * (soil.velocity(i) - before.velocity(i));
    balance.weight += soil.m[i] * k.g;
  }
  return balance;
}

TEST(WallLoad, IsWhatTheSoilsMomentumLoses) {
  for (const bool vectorised : {false, true})
    for (const auto integrator : {Integrator::rk2, Integrator::leapfrog})
      for (const auto jump : {VelocityJump::reconstructed, VelocityJump::whole}) {
        const Balance b = balance_of_a_step(vectorised, integrator, jump);
        ASSERT_GT(norm(b.loads[0].force), 0.01 * norm(b.weight)) << "nothing presses";
        ASSERT_GT(norm(b.loads[1].force), 0.01 * norm(b.weight)) << "nothing presses";
        const Vec2 gained = b.weight - b.loads[0].force - b.loads[1].force;
        // Double precision to rounding; single precision to 1e-5 of the sum of the pair forces' sizes, which is about
        // that of the load.
        const double rounding = (vectorised ? 1e-5 : 1e-11) * (norm(b.weight) + norm(b.loads[0].force));
        EXPECT_NEAR(b.gained.x, gained.x, rounding) << vectorised;
        EXPECT_NEAR(b.gained.y, gained.y, rounding) << vectorised;
      }
}

TEST(WallLoad, IsTheSameByBothLoops) {
  const Balance plain = balance_of_a_step(false, Integrator::leapfrog, VelocityJump::reconstructed),
                fast = balance_of_a_step(true, Integrator::leapfrog, VelocityJump::reconstructed);
  for (const std::size_t b : {0, 1}) {
    const double size = norm(plain.loads[b].force);
    EXPECT_NEAR(fast.loads[b].force.x, plain.loads[b].force.x, 1e-4 * size);
    EXPECT_NEAR(fast.loads[b].force.y, plain.loads[b].force.y, 1e-4 * size);
    EXPECT_NEAR(fast.loads[b].moment, plain.loads[b].moment, 1e-4 * size);
    EXPECT_GT(std::abs(plain.loads[b].moment), 0.01 * size);
  }
}

TEST(WallLoad, HasTheSameBitsForAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Balance one = balance_of_a_step(true, Integrator::leapfrog, VelocityJump::reconstructed);
  omp_set_num_threads(3);
  const Balance three = balance_of_a_step(true, Integrator::leapfrog, VelocityJump::reconstructed);
  omp_set_num_threads(before);
  EXPECT_EQ(one.loads, three.loads);
}

}  // namespace
}  // namespace talus
